#pragma once

#include <array>

namespace misfit::imager {

/// The most terms of a spectrum.
constexpr int most_taylor_terms = 3;

/// A number for each term; 0 beyond those in use.
using TaylorValues = std::array<double, most_taylor_terms>;

/// How the sky's spectra are written: as polynomials of the distance from a reference frequency ν_0, relative to it,
///
///     I(ν) = Σ_{t < terms} I_t x^t,   x = (ν − ν_0)/ν_0        (Rau & Cornwell 2011, A&A 532, A71).
///
/// The operator of imaging is then V = Σ_t x^t A I_t, and its adjoint gives the images A*(x^t V).
struct TaylorExpansion {
  double reference_hz = 0;
  int terms = 1;  ///< [1, most_taylor_terms]

  double x(double frequency_hz) const { return (frequency_hz - reference_hz) / reference_hz; }
};

}  // namespace misfit::imager
