#pragma once

#include "imager/beams/voltage_pattern.h"

namespace misfit::imager {

/// A dish as its beam shows it: a circular aperture, uniformly lit, but for a dark disc in its middle.
struct Dish {
  double diameter_m = 0;  ///< effective: it gives the beam its observed width
  double blockage_m = 0;  ///< of the disc; 0: none
};

/// The transform of the lit ring (Born & Wolf 1999, Principles of Optics, section 8.6.2; Thompson, Moran & Swenson 2017,
/// Interferometry and Synthesis in Radio Astronomy),
///
///     V(x) = (2 J₁(x)/x − b² 2 J₁(bx)/(bx)) / (1 − b²),   x = π D sin θ / λ,   b = blockage / D.
///
/// Without blockage V² is the Airy disc: ½ at 0.514 497 λ/D, 0 at 1.219 670 λ/D. `sin_per_wavelength` is sin θ / λ, 1/m.
/// CASA (PBMath1DAiry) takes J₁ of x/b and not of bx, which makes beams wider: for ALMA's dishes by 0.9 % at half power.
double airy_voltage(const Dish& dish, double sin_per_wavelength);

/// sin θ / λ, 1/m, at which airy_voltage() is first 0: 1.219 670/D for an open dish, less with a blockage.
double first_null_per_m(const Dish& dish);

/// Throws std::invalid_argument unless 0 ≤ blockage < diameter.
Pattern airy_pattern(const Dish& dish);

}  // namespace misfit::imager
