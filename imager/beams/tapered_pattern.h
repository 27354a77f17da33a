#pragma once

#include "imager/beams/voltage_pattern.h"

namespace misfit::imager {

/// A field that falls as a cosine from the middle of the aperture to its edge,
///
///     V = cos(πx) / (1 − 4x²),   x = 1.189 θ / width,
///
/// whose power is ½ at width/2 (Condon & Ransom 2016, Essential Radio Astronomy, section 3.2). `width_arcmin_ghz` is the width
/// between half-power points times the frequency.
Pattern cosine_tapered_pattern(double width_arcmin_ghz);

/// V = cos³(β θ ν) down to its first null. β is `beta_low` below `change_hz` and `beta_high` above, in degrees for each degree
/// and MHz. WSRT's (the NEWSTAR manual; CASA, PBMath).
Pattern cosine_cubed_pattern(double beta_low, double beta_high, double change_hz);

/// A power that is a Gaussian, down to a thousandth of the peak: its width between half-power points is so many times λ over
/// the diameter.
Pattern gaussian_pattern(double widths, double diameter_m);

}  // namespace misfit::imager
