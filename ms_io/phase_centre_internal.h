#pragma once

#include "imager/data/phase_shift.h"
#include "ms_io/field_directions_internal.h"
#include "ms_io/phase_centre.h"

namespace misfit::ms_io {

/// Nearer than this, phase centres count as the same: a hundredth of the finest beams, 20 microarcseconds. Rounding takes
/// them 4e-16 apart, in conversions between J2000 and ICRS too.
constexpr double same_centre_rad = 1e-12;

/// The angle between two directions, whatever their frames; B1950 as it was in 1950.
double separation_rad(const imager::SkyDirection& a, const imager::SkyDirection& b);

/// The shift of visibilities from `from` to `to`, along whose north v then runs, in the frame of `to`.
imager::PhaseShift phase_shift(const FieldCentre& from, const imager::SkyDirection& to);

}  // namespace misfit::ms_io
