#pragma once

#include "tools/emit/host.h"

namespace misfit::tools {

/// How far a host's transform is from the exact one, in two dimensions: relative errors of images or visibilities of sources
/// with random phases, anywhere in the part of the FFT image that is kept.
struct RealisedError {
  double rms = 0;
  double largest = 0;  ///< of one visibility and one pixel, at their worst places
};

/// The error of taps and correction without rounding, over |x| ≤ x0. With e = 1 − h(x) Σ_r C_r(t) exp(2πi(s_r−t)x) along an
/// axis, E the mean of |e|² and m the mean of e, two axes give 1 − (1−e)(1−e'), whose mean square is 2E + 2m² + E² − 4Em.
RealisedError realised_error(const HostRule& rule, double x0);

/// The error that rounding to `bits` adds, about, relative to the image: the rounding of one visibility's taps, 2^-bits,
/// magnified by the correction along both axes. It grows with the number of visibilities that share a cell.
double rounding(const kernels::PiecewisePolynomial& function, double x0, int bits);

/// The error with the rounding added: rms in quadrature, largest by 6 times the rounding.
RealisedError with_rounding(const RealisedError& error, double rounding);

}  // namespace misfit::tools
