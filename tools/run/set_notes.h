#pragma once

#include "tools/run/field_beams.h"

namespace misfit::tools {

/// What users should know of the sets that are imaged before a visibility is read, of whatever makes an image: columns that
/// were not written to their end, phase centres that move or differ by rounding, frames, and the fields of an image, see
/// notes_on_fields(), whose errors it throws.
FieldNotes notes_on_sets(const ImageOptions& options, const ms_io::MeasurementSet& set, const imager::ImageGeometry& geometry);

/// The same of data that `ranks` have read, which call it together: columns that nothing has filled, or not everywhere.
std::vector<std::string> notes_on_data(const ms_io::MeasurementSet& set, const imager::Ranks& ranks);

}  // namespace misfit::tools
