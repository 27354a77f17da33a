#pragma once

#include <casacore/measures/Measures/MDirection.h>
#include <casacore/measures/Measures/MEpoch.h>
#include <casacore/measures/Measures/MeasFrame.h>
#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include <string>

#include "imager/phase_shift.h"
#include "ms_io/phase_centre.h"
#include "ms_io/selection_internal.h"

namespace misfit::ms_io {

/// Nearer than this, phase centres count as the same: a hundredth of the finest beams, 20 microarcseconds. Rounding takes
/// them 4e-16 apart, in conversions between J2000 and ICRS too.
constexpr double same_centre_rad = 1e-12;

/// Where a field is phased to.
struct FieldCentre {
  int field = 0;
  std::string name;
  imager::SkyDirection direction;
  casacore::MEpoch observed;  ///< at which B1950 is taken: it turns against the other frames, by 0.1 arcsec in 30 years
};

/// The phase centre of `field` at the time of `row`, in J2000 where its own frame is neither that nor ICRS or B1950. Throws
/// std::runtime_error when there is no such field.
FieldCentre field_centre(const casacore::MeasurementSet& set, const std::string& path, int field, std::uint64_t row);

/// When and where the row was observed: from the telescope's place, or the first antenna's where casacore does not know that.
casacore::MeasFrame frame_of(const casacore::MeasurementSet& set, std::uint64_t row);

/// Where the antennas of `field` point at the time of `row`: its REFERENCE_DIR, in such a frame. Throws what that does.
imager::SkyDirection field_pointing(const casacore::MeasurementSet& set, const std::string& path, int field, std::uint64_t row);

/// The angle between two directions, whatever their frames; B1950 as it was in 1950.
double separation_rad(const imager::SkyDirection& a, const imager::SkyDirection& b);

/// The way of visibilities from `from` to `to`, along whose north v then runs, in the frame of `to`.
imager::PhaseShift phase_shift(const FieldCentre& from, const imager::SkyDirection& to);

}  // namespace misfit::ms_io
