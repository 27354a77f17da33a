#pragma once

#include <vector>

#include "imager/data/image.h"

namespace misfit::imager {

/// As many pixels from its peak a PSF still fits a cache.
inline constexpr int largest_psf_core = 512;

/// The middle of a PSF in single precision, as much of it as pays: all |row|, |column| ≤ reach from its peak.
class PsfCore {
 public:
  /// The smallest reach beyond which the PSF is hardly weaker (by a tenth) than beyond largest_psf_core. NaN
  /// counts as 0, as does what lies beyond the PSF.
  explicit PsfCore(const Image& psf);
  /// All up to a reach.
  PsfCore(const Image& psf, int reach);

  int reach() const { return reach_; }
  /// The largest magnitude of the PSF outside.
  double largest_outside() const { return largest_outside_; }
  /// At columns −reach … reach of a row in [−reach, reach]; points to column 0.
  const float* row(int r) const {
    const std::size_t side = 2 * static_cast<std::size_t>(reach_) + 1;
    return value_.data() + static_cast<std::size_t>(r + reach_) * side + reach_;
  }

 private:
  /// `beyond`: the largest magnitude at each distance from the middle or beyond it.
  PsfCore(const Image& psf, int reach, const std::vector<double>& beyond);
  PsfCore(const Image& psf, const std::vector<double>& beyond);

  int reach_ = 0;
  double largest_outside_ = 0;
  std::vector<float> value_;  ///< [row + reach][column + reach]
};

}  // namespace misfit::imager
