#pragma once

#include "imager/beams/beam.h"

namespace misfit::imager {

/// Multiplies weights by exp(−a (u sin P + v cos P)² − b (v sin P − u cos P)²), u and v in wavelengths: a along the position
/// angle P, from v (north) through u (east), b across it.
struct UvTaper {
  double along = 0;   ///< a, wavelengths⁻²
  double across = 0;  ///< b
  double position_angle_rad = 0;
};

/// The taper that is the transform of a Gaussian beam on the sky, a = (π major)²/(4 ln 2): tapered by it, evenly spread samples
/// have that beam as their PSF. CASA's VisImagingWeight::setFilter multiplies major² by 4 ln 2 in place of π²/(4 ln 2): to
/// taper as tclean does with an angle, ask for 4 ln 2/π = 0.8825 of that angle.
UvTaper taper_of_beam(const Beam& beam);

/// Half widths at half maximum in the uv plane, in wavelengths, a = ln 2/along²; CASA's too.
struct UvRadii {
  double along_lambda = 0;
  double across_lambda = 0;
  double position_angle_rad = 0;
};
UvTaper taper_of_radii(const UvRadii& radii);

/// −ln of the factor at u and v in metres, to be multiplied by (frequency/c)².
double taper_exponent_m2(const UvTaper& taper, double u_m, double v_m);

}  // namespace misfit::imager
