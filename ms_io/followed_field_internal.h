#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "imager/data/observation.h"
#include "ms_io/row_shares_internal.h"

namespace misfit::ms_io {

/// Where the phase centre of a set differs from the first set's by little more than rounding, or one of the two moves by no
/// more, opens these sets anew with `selection`, which then has the first set's phase centre. Says so in sentences.
std::vector<std::string> shift_from_rounding(OpenSets& sets, Selection& selection,
                                             const std::function<std::shared_ptr<const OpenSet>(const OpenSet&)>& reopened);

/// Puts the header of an image that moves with fields of several sets where the field was in the middle of the run of all or,
/// where that lies between two sets, at the time observed that is nearest to it. Throws std::runtime_error, which names both,
/// unless the fields follow one target: by the ephemeris of one as far as it covers the times of the other, or else by their
/// names.
void follow_one_target(const OpenSets& sets, imager::Observation& observation);

/// See MeasurementSet::followed_at().
std::optional<imager::SkyDirection> followed_at(const OpenSet& set, const std::string& utc);

/// See MeasurementSet::remarks(); of sets selected by `selection`, for the image of this header.
std::vector<std::string> remarks_on(const OpenSets& sets, const Selection& selection, const imager::Observation& observation);

}  // namespace misfit::ms_io
