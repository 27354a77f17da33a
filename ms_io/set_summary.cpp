#include <casacore/measures/TableMeasures/ScalarMeasColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include "ms_io/field_directions_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/set_summary_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

/// The start and end of a row's integration, UTC.
struct Integration {
  double start_s = 0;
  double end_s = 0;
};

Integration integration_of(const casacore::MeasurementSet& set, std::uint64_t row) {
  const double middle_s = utc_s(casacore::ScalarMeasColumn<casacore::MEpoch>(set, "TIME")(row));
  const double half_s = casacore::ScalarColumn<double>(set, "INTERVAL")(row) / 2;
  return {middle_s - half_s, middle_s + half_s};
}

}  // namespace

SetSummary summary_of(const OpenSet& open_set) {
  const casacore::MeasurementSet& set = open_set.set;
  const SelectedRows& selected = open_set.selected;
  SetSummary summary;
  summary.path = open_set.path;
  translated("cannot read what " + open_set.path + " says of its observation", [&] {
    summary.telescope = telescope_name(set, observation_of(set, selected.first_row));
    summary.antennas = set.antenna().nrow();
    summary.all_fields = set.field().nrow();
    summary.all_windows = set.spectralWindow().nrow();
    const FieldDirections directions(set, open_set.path);
    for (const auto& [field, row] : selected.first_row_of_field) summary.fields.push_back({field, directions.name(field)});
    if (!selected.last_row) return;
    const Integration first = integration_of(set, selected.first_row), last = integration_of(set, *selected.last_row);
    constexpr double calendar_ends_s = 4e11;  // MJD 0 is the year 1858, and this 14500: times beyond are no dates
    if (!(first.start_s > 0 && last.end_s < calendar_ends_s)) return;
    summary.start_utc = utc_text(first.start_s);
    summary.end_utc = utc_text(last.end_s);
    summary.length_s = last.end_s - first.start_s;
  });
  return summary;
}

}  // namespace misfit::ms_io
