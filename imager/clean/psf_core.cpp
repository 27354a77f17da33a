#include "imager/clean/psf_core.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace misfit::imager {
namespace {

/// [ring]: the largest magnitude at that distance from the middle or beyond it, a distance being the larger of rows and
/// columns.
std::vector<double> largest_beyond(const Image& psf) {
  const int rows = psf.height / 2, columns = psf.width / 2;
  std::vector<double> largest(static_cast<std::size_t>(std::max(rows, columns)) + 2);
  for (int r = 0; r < psf.height; ++r)
    for (int c = 0; c < psf.width; ++c) {
      double& ring = largest[static_cast<std::size_t>(std::max(std::abs(r - rows), std::abs(c - columns)))];
      ring = std::fmax(ring, std::abs(psf.at(r, c)));  // not NaN
    }
  for (std::size_t ring = largest.size() - 1; ring-- > 0;) largest[ring] = std::max(largest[ring], largest[ring + 1]);
  return largest;
}

/// See PsfCore.
int reach_that_pays(const std::vector<double>& beyond) {
  constexpr double hardly = 1.1;
  const auto outside = [&](int reach) { return beyond[static_cast<std::size_t>(reach) + 1]; };
  const int end = std::min(largest_psf_core, static_cast<int>(beyond.size()) - 2);
  int reach = 0;
  while (reach < end && outside(reach) > hardly * outside(end)) ++reach;
  return reach;
}

}  // namespace

PsfCore::PsfCore(const Image& psf) : PsfCore(psf, largest_beyond(psf)) {}

PsfCore::PsfCore(const Image& psf, int reach) : PsfCore(psf, reach, largest_beyond(psf)) {}

PsfCore::PsfCore(const Image& psf, const std::vector<double>& beyond) : PsfCore(psf, reach_that_pays(beyond), beyond) {}

PsfCore::PsfCore(const Image& psf, int reach, const std::vector<double>& beyond) : reach_(reach) {
  largest_outside_ = beyond[std::min(static_cast<std::size_t>(reach_) + 1, beyond.size() - 1)];
  value_.reserve(static_cast<std::size_t>(2 * reach_ + 1) * static_cast<std::size_t>(2 * reach_ + 1));
  for (int r = -reach_; r <= reach_; ++r)
    for (int c = -reach_; c <= reach_; ++c) {
      const int row = psf.height / 2 + r, column = psf.width / 2 + c;
      const bool inside = row >= 0 && row < psf.height && column >= 0 && column < psf.width;
      const double value = inside ? psf.at(row, column) : 0;
      value_.push_back(std::isnan(value) ? 0 : static_cast<float>(value));
    }
}

}  // namespace misfit::imager
