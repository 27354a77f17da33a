#pragma once

#include <optional>
#include <string>
#include <vector>

#include "imager/data/observation.h"
#include "ms_io/row_shares_internal.h"

namespace misfit::ms_io {

/// The phase centre of the first set, where that of the other differs from it by little more than rounding; nothing where it is
/// the same, is another, or moves.
std::optional<imager::SkyDirection> centre_but_for_rounding(const OpenSet& first, const OpenSet& other);

/// Puts the header of an image that moves with fields of several sets where the field was in the middle of the run of all or,
/// where that lies between two sets, at the time observed that is nearest to it. Throws std::runtime_error, which names both,
/// unless the fields follow one target, as far as the times of one lie within the ephemeris of the other, or else their names
/// tell.
void follow_one_target(const OpenSets& sets, imager::Observation& observation);

/// See MeasurementSet::remarks(), of sets that were selected so, and are the image of this header.
std::vector<std::string> remarks_on(const OpenSets& sets, const Selection& selection, const imager::Observation& observation);

}  // namespace misfit::ms_io
