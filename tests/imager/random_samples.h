#pragma once

#include <random>

#include "imager/data/visibilities.h"
#include "imager/numerics/constants.h"

namespace misfit::imager::testing {

/// Rows of random UVW (w = 0) that fill |u|, |v| < reach/(2 cell), random weights and random visibilities.
inline VisibilityBlock random_samples(std::size_t rows, std::size_t channels, double cell_rad, unsigned seed,
                                      double reach = 0.99) {
  std::mt19937_64 random(seed);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<double> uniform(-1, 1);
  VisibilityBlock block;
  for (std::size_t channel = 0; channel < channels; ++channel)
    block.frequency_hz.push_back(1e9 * (1 + 0.3 * static_cast<double>(channel) / static_cast<double>(channels)));
  const double edge_m = reach / (2 * cell_rad) * speed_of_light_m_s / block.frequency_hz.back();
  for (std::size_t row = 0; row < rows; ++row) {
    const double u_m = edge_m * uniform(random);
    const double v_m = edge_m * uniform(random);
    for (const double x : {u_m, v_m, 0.0}) block.uvw_m.edit().push_back(x);
  }
  for (std::size_t i = 0; i < rows * channels; ++i) {
    block.visibility.emplace_back(normal(random), normal(random));
    block.weight.push_back(static_cast<float>(0.5 + std::abs(uniform(random))));
  }
  return block;
}

/// The same with w anywhere up to `max_w` wavelengths at the highest frequency, of both signs.
inline VisibilityBlock random_samples_with_w(std::size_t rows, std::size_t channels, double cell_rad, double max_w,
                                             unsigned seed, double reach = 0.99) {
  VisibilityBlock block = random_samples(rows, channels, cell_rad, seed, reach);
  std::mt19937_64 random(seed + 1000);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double most_m = max_w * speed_of_light_m_s / block.frequency_hz.back();
  for (std::size_t row = 0; row < rows; ++row) block.uvw_m.edit()[3 * row + 2] = most_m * uniform(random);
  return block;
}

}  // namespace misfit::imager::testing
