#pragma once

#include <optional>
#include <string>
#include <vector>

#include "imager/data/geometry.h"
#include "ms_io/selection.h"

namespace misfit::ms_io {

/// The direction that `text` states: a frame and angles, as parse_phase_centre() takes them, which looks for fields of a name
/// besides. Nothing where it is none.
std::optional<imager::SkyDirection> parse_direction(const std::string& text);

/// The direction that `text` means, as CASA's tasks take it: "J2000 12h30m49.4s +12d23m28s", with J2000 (also when left out),
/// ICRS or B1950, angles such as 12h30m49.4s, 12:30:49.4, +12d23m28s, +12.23.28 and 187.7deg; or a field of the MeasurementSet
/// at `path`, by its id or, where that is none, its name, for its phase centre, and where that moves, for where it is in the
/// middle of the field's rows. Throws std::runtime_error that says what was expected, also where fields of one name are phased
/// to several directions.
imager::SkyDirection parse_phase_centre(const std::string& text, const std::string& path);

/// `selection` with its visibilities phased to what `text` means: a direction as for parse_phase_centre(), or a field of the
/// first of the sets at `paths` that has it; "TRACKFIELD", for what the fields of the sets follow; a planet, the Sun or the
/// Moon by name, which goes before fields of that name; or the path of the table of an ephemeris, as CASA writes them. Throws
/// what parse_phase_centre() does, also where that table is not as expected.
Selection phased_to(Selection selection, const std::string& text, const std::vector<std::string>& paths);

}  // namespace misfit::ms_io
