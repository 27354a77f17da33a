#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "imager/coplanar/correction.h"
#include "imager/data/image.h"
#include "imager/wide/column_loops.h"
#include "imager/wide/facet.h"

namespace misfit::imager {

/// A facet with the distance of its planes in wavelengths, and the corrections of the kernels over its pixels.
struct StackedFacet {
  Facet facet;
  double plane_step = 0;
  std::vector<double> h_u;  ///< [column]
  std::vector<double> h_v;  ///< [row]
  SmoothCorrection h_w;     ///< of plane_step · q
};

/// The pixels of a group of neighbouring columns of a facet: a complex sum for each, their corrections, and the phasors that
/// lead from plane to plane.
class ColumnGroup {
 public:
  explicit ColumnGroup(const StackedFacet& facet);

  /// Takes columns [begin, end), at most columns_at_once.
  void begin(const StackedFacet& facet, int begin, int end);
  void clear();
  /// sum = h · image · exp(−2πi q w_first); 0 beyond the horizon.
  void load(const Image& image, const Facet& facet, int first_plane);
  /// image += h · Re(sum · exp(+2πi q w_first)).
  void store(const Facet& facet, int first_plane, Image& image);

  /// Adds one plane of column c, in the order of an FFT of length n: Horner's rule; and its transpose.
  template <typename Real>
  void turn_and_add(int c, const std::complex<Real>* column, int n) {
    in_fft_order(c, n, [&](std::size_t i, int place, int count) {
      imager::turn_and_add(sum().from(i), half_step().from(i), column + place, count);
    });
  }
  template <typename Real>
  void store_and_turn(int c, std::complex<Real>* column, int n) {
    in_fft_order(c, n, [&](std::size_t i, int place, int count) {
      imager::store_and_turn(sum().from(i), half_step().from(i), column + place, count);
    });
  }

 private:
  std::size_t at(int c) const { return static_cast<std::size_t>(c - begin_) * static_cast<std::size_t>(height_); }
  ColumnPhasors sum() { return {sum_re_.data(), sum_im_.data()}; }
  ColumnPhasors half_step() { return {half_step_re_.data(), half_step_im_.data()}; }

  template <typename Visit>
  void in_fft_order(int c, int n, const Visit& visit) {
    const int below = height_ / 2;
    visit(at(c), n - below, below);
    visit(at(c) + static_cast<std::size_t>(below), 0, height_ - below);
  }
  /// sum *= exp(2πi q planes).
  void turn(int planes);

  int begin_ = 0, end_ = 0, height_;
  std::vector<double> q_, h_, half_step_re_, half_step_im_, sum_re_, sum_im_;  ///< [column in group][row]; q in planes
  std::vector<double> half_;                                                   ///< [row]: q/2
};

}  // namespace misfit::imager
