#include "tools/run/set_notes.h"

#include "tools/run/data_columns.h"

namespace misfit::tools {

FieldNotes notes_on_sets(const ImageOptions& o, const ms_io::MeasurementSet& set, const imager::ImageGeometry& geometry) {
  FieldNotes notes = notes_on_fields(o, set, geometry);
  std::vector<std::string> warnings = set.incomplete_columns();
  warnings.insert(warnings.end(), set.remarks().begin(), set.remarks().end());
  notes.warnings.insert(notes.warnings.begin(), warnings.begin(), warnings.end());
  return notes;
}

std::vector<std::string> notes_on_data(const ms_io::MeasurementSet& set, const imager::Ranks& ranks) {
  std::vector<std::string> warnings;
  for (const ms_io::ZeroColumn& column : set.columns_of_zeros(ranks)) warnings.push_back(zeros_warning(column));
  return warnings;
}

}  // namespace misfit::tools
