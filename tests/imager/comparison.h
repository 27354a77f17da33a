#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "imager/data/image.h"
#include "imager/data/stored_visibilities.h"

namespace misfit::imager::testing {

/// ‖x‖₂.
template <typename T>
double norm(const std::vector<T>& x) {
  double sum = 0;
  for (const T& value : x) sum += std::norm(value);
  return std::sqrt(sum);
}

/// ‖is − should‖₂.
template <typename T>
double distance(const std::vector<T>& is, const std::vector<T>& should) {
  std::vector<T> difference(is.size());
  for (std::size_t i = 0; i < is.size(); ++i) difference[i] = is[i] - should[i];
  return norm(difference);
}

/// ‖is − should‖₂ / ‖should‖₂.
template <typename T>
double relative_error(const std::vector<T>& is, const std::vector<T>& should) {
  return distance(is, should) / norm(should);
}

/// Independent normal pixels.
inline Image random_image(int width, int height, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Image image(width, height);
  for (double& pixel : image.pixel) pixel = normal(random);
  return image;
}

/// A source of these blocks.
inline StoredVisibilities stored(const std::vector<VisibilityBlock>& blocks) {
  StoredVisibilities source;
  for (const VisibilityBlock& block : blocks) source.append(std::make_shared<VisibilityBlock>(block));
  return source;
}

}  // namespace misfit::imager::testing
