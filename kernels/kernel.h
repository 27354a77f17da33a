#pragma once

#include <string>

#include "kernels/map_error.h"
#include "kernels/piecewise_polynomial.h"

namespace misfit::kernels {

/// A gridding function, made for the retained fraction 2·x0 of an FFT image. Everything else (correction, map error) derives
/// from the polynomial.
struct Kernel {
  std::string name;
  double x0 = 0.25;                ///< half the retained fraction of the FFT image: image size / (2 × FFT size), below 1/2
  PiecewisePolynomial polynomial;  ///< the stored form; evaluation anywhere goes through it
  Misfit misfit;                   ///< of the stored polynomial over |x| ≤ x0

  int width() const { return polynomial.width(); }
};

/// Stores `taps` as the polynomial of lowest degree that adds less than 0.5% to the mean map error, or
/// that comes closest where the rounding of doubles allows none.
Kernel make_kernel(const std::string& name, double x0, const TapFunction& taps);

}  // namespace misfit::kernels
