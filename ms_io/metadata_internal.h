#pragma once

#include <string>

#include "imager/data/observation.h"
#include "ms_io/field_centres_internal.h"
#include "ms_io/row_shares_internal.h"

namespace misfit::ms_io {

/// The observation in the image header of the rows selected; where the image moves with a field, with the field's place in the
/// middle of the rows. Throws std::runtime_error where that place cannot be found.
imager::Observation describe(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected);

/// OBSERVATION_ID of `row`.
int observation_of(const casacore::MeasurementSet& set, std::uint64_t row);

/// TELESCOPE_NAME of a row of OBSERVATION; empty where there is none.
std::string telescope_name(const casacore::MeasurementSet& set, int observation);

/// Seconds of UTC, and these in ISO 8601; empty where they are not finite.
double utc_s(const casacore::MEpoch& time);
std::string utc_text(double utc_s);

/// Centres the header of an image that moves with a field on the field's place at a time.
void centre_on_field(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected, double time_s,
                     imager::Observation& observation);

/// The observation in the header of one image of all sets: the first set's, with the band of all. Throws std::runtime_error
/// when two sets have different phase centres, or move with different targets.
imager::Observation joined(const OpenSets& sets);

}  // namespace misfit::ms_io
