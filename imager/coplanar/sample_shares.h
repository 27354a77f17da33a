#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "imager/coplanar/tile_positions.h"

namespace misfit::imager {

/// The most images that are gridded together, in each of which a sample has a share.
inline constexpr std::size_t most_shared_images = 32;

/// Shares c_k in several images as functions of w ≥ 0, at equal steps of it, between which they follow by Lagrange's formula of
/// six points; for −w they are conjugate.
class ShareTable {
 public:
  static constexpr int points = 6;
  static constexpr int before = points / 2 - 1;  ///< points before the one at the step of w

  ShareTable() = default;
  /// Shares [point][Re, Im][image]. The first point lies `before` steps below 0, the last `before` + 1 steps above the largest
  /// w that is asked for.
  ShareTable(std::size_t images, const std::vector<double>& shares);

  /// The bytes of a table of so many images and points.
  static double bytes(std::size_t images, std::size_t points);

  /// The largest whole step at or below a w that may be asked for.
  std::size_t last() const { return last_; }
  /// Numbers from one point to the next, and from a point's Re to its Im.
  std::size_t point_stride() const { return 2 * stride_; }
  std::size_t part_stride() const { return stride_; }
  /// Re c_k of the first of the points for a w between `step` and the next step. Numbers behind the images may be read, and are
  /// 0 or belong to others.
  const float* at(std::size_t step, float) const { return single_.data() + step * point_stride(); }
  const double* at(std::size_t step, double) const { return double_.data() + step * point_stride(); }

 private:
  std::size_t stride_ = 0;
  std::size_t last_ = 0;
  std::vector<float> single_;
  std::vector<double> double_;
};

/// The shares of a block's samples in several images I_k that together make visibilities, V = Σ_k c_k A I_k.
struct SampleShares {
  std::vector<const ShareTable*> of_channel;
  std::size_t first = 0;  ///< of the table's images
  std::size_t images = 0;
  double steps_a_wavelength = 0;                ///< of the tables, for the block's w
  const std::complex<double>* phase = nullptr;  ///< a further factor of all shares of a sample. [row][channel]
};

}  // namespace misfit::imager
