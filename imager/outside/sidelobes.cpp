#include "imager/outside/sidelobes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace misfit::imager {

Sidelobes::Sidelobes(const Image& psf) {
  const int rings = std::max(1, std::min(psf.width, psf.height) / 4);
  highest_.assign(static_cast<std::size_t>(rings) + 1, 0.0);
  for (int row = 0; row < psf.height; ++row)
    for (int column = 0; column < psf.width; ++column) {
      const double level = std::abs(psf.at(row, column));
      const int ring = std::max(std::abs(row - psf.height / 2), std::abs(column - psf.width / 2));
      double& highest = highest_[static_cast<std::size_t>(std::min(ring, rings))];
      if (!std::isnan(level)) highest = std::max(highest, level);
    }
  highest_.front() = 1;
  for (auto ring = highest_.rbegin(); ring + 1 != highest_.rend(); ++ring) *(ring + 1) = std::max(*(ring + 1), *ring);
}

double Sidelobes::from(double pixels) const {
  const double last = static_cast<double>(highest_.size() - 1);
  return highest_[static_cast<std::size_t>(std::clamp(pixels, 0.0, last))];
}

void Sidelobes::raise_to(double level) {
  for (double& highest : highest_) highest = std::max(highest, level);
}

}  // namespace misfit::imager
