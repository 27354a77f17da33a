#pragma once

#include "tools/run/field_beams.h"

namespace misfit::tools {

/// Notes for users on the sets, before a visibility is read, for every command that makes an image: columns that were not
/// written to their end, phase centres that move or differ by rounding, frames, and the fields of an image, see
/// notes_on_fields(), whose errors it throws.
FieldNotes notes_on_sets(const ImageOptions& options, const ms_io::MeasurementSet& set, const imager::ImageGeometry& geometry);

/// Sentences for users on the data that `ranks` have read, which call it together: columns that nothing has filled, or not
/// everywhere.
std::vector<std::string> notes_on_data(const ms_io::MeasurementSet& set, const imager::Ranks& ranks);

}  // namespace misfit::tools
