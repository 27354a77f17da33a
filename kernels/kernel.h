#pragma once

#include <limits>
#include <optional>
#include <string>

#include "kernels/map_error.h"
#include "kernels/piecewise_polynomial.h"

namespace misfit::kernels {

/// Facts about the gridding function before it was stored, and how it was found.
struct Origin {
  double mean_error = 0;                                              ///< E, the mean of ℓ over |x| ≤ x0
  double max_error = 0;                                               ///< largest ℓ over |x| ≤ x0
  double max_error_bound = std::numeric_limits<double>::quiet_NaN();  ///< a lower bound of any function's max ℓ, where known
  double condition = std::numeric_limits<double>::quiet_NaN();        ///< of the normal equations for C, where solved
  double parameter = std::numeric_limits<double>::quiet_NaN();        ///< β or bandwidth of a family that has one
  int iterations = 0;
  std::string precision = "double";  ///< the arithmetic of the solution: double, quadruple or 256 bits
};

/// A gridding function, made for the retained fraction 2·x0 of an FFT image. Everything else (correction, map error) derives
/// from the polynomial.
struct Kernel {
  std::string name;
  double x0 = 0.25;                ///< half the retained fraction of the FFT image: image size / (2 × FFT size), below 1/2
  PiecewisePolynomial polynomial;  ///< the stored form; evaluation anywhere goes through it
  Misfit misfit;                   ///< of the stored polynomial over |x| ≤ x0
  Origin origin;

  int width() const { return polynomial.width(); }
};

/// Stores `function`, scaled so that h(0) = 1, as the polynomial of lowest degree that is true to it: values to 1e-10, and E to
/// 1e-7 of itself, as far as doubles and highest_degree hold it. Without an `origin` the function is judged as it is.
Kernel make_kernel(const std::string& name, double x0, const TapFunction& function, const std::optional<Origin>& origin = {});

/// The kernel with polynomials of at most `degree`: higher ones are cut to it and judged anew.
Kernel truncated(const Kernel& kernel, int degree);

}  // namespace misfit::kernels
