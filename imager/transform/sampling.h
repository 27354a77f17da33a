#pragma once

#include <cmath>
#include <complex>
#include <vector>

#include "imager/data/geometry.h"
#include "imager/numerics/constants.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

/// True if an image with this cell can represent a sample: |u| and |v| up to 1/(2 cell), in turns per cell up to ½.
inline bool inside_grid(double u_turns, double v_turns) {
  return std::abs(u_turns) <= 0.5 && std::abs(v_turns) <= 0.5;
}

/// The largest integer that does not exceed x, for |x| below 2^31: std::floor is a call where the instruction may be missing.
inline int floor_to_int(double x) {
  const int towards_zero = static_cast<int>(x);
  return towards_zero - (x < towards_zero ? 1 : 0);
}

/// Adds one sample to the sums, without counting it.
inline void add_to_sums(SampleSums& sums, double weight, std::complex<double> visibility) {
  const double square = std::norm(visibility);
  sums.weight += weight;
  sums.weight_abs += weight * std::sqrt(square);
  sums.weight_square += weight * square;
  sums.weight2_square += weight * weight * square;
}

/// Which samples take part in imaging.
struct ImagedSamples {
  ImageGeometry geometry;
  bool beyond_grid = false;  ///< see AdjointOptions
  int threads = 1;
};

/// The block's weights [row][channel], 0 for samples that take no part in imaging. Counts samples that take part as used, and
/// samples outside the grid.
std::vector<float> imaging_weights(const VisibilityBlock& block, const ImagedSamples& imaged, SampleSums& sums);

}  // namespace misfit::imager
