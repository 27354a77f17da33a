#include <casacore/casa/Quanta/MVTime.h>
#include <casacore/measures/Measures/MCEpoch.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/TableMeasures/ScalarMeasColumn.h>
#include <casacore/ms/MeasurementSets/MSObservation.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "ms_io/metadata_internal.h"
#include "ms_io/phase_centre_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

/// The cell of a scalar column, or `otherwise` when the row or the column does not exist.
template <typename T>
T cell_or(const casacore::Table& table, const char* column, casacore::Int64 row, const T& otherwise) {
  if (row < 0 || static_cast<casacore::rownr_t>(row) >= table.nrow() || !table.tableDesc().isColumn(column)) return otherwise;
  return casacore::ScalarColumn<T>(table, column)(static_cast<casacore::rownr_t>(row));
}

std::string label(const FieldCentre& centre) {
  return std::to_string(centre.field) + " (" + centre.name + ")";
}

FieldCentre common_centre(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected) {
  std::vector<FieldCentre> centres;
  for (const auto& [field, row] : selected.first_row_of_field) centres.push_back(field_centre(set, path, field, row));
  for (const FieldCentre& centre : centres) {
    const double apart = separation_rad(centres.front().direction, centre.direction);
    if (apart <= same_centre_rad) continue;
    std::ostringstream message;
    message << path << ": fields " << label(centres.front()) << " and " << label(centre) << " have phase centres " << apart
            << " rad apart; select one with --field, or shift all to one with --phasecenter";
    throw std::runtime_error(message.str());
  }
  const int field_of_first_row = casacore::ScalarColumn<int>(set, "FIELD_ID")(selected.first_row);
  return *std::find_if(centres.begin(), centres.end(), [&](const auto& centre) { return centre.field == field_of_first_row; });
}

/// The start of the integration of `row`, UTC.
std::string start_time(const casacore::MeasurementSet& set, std::uint64_t row) {
  const casacore::MEpoch middle = casacore::ScalarMeasColumn<casacore::MEpoch>(set, "TIME")(row);
  const casacore::MEpoch utc = casacore::MEpoch::Convert(middle, casacore::MEpoch::UTC)();
  const double start_s = utc.get("s").getValue() - casacore::ScalarColumn<double>(set, "INTERVAL")(row) / 2;
  if (!std::isfinite(start_s)) return "";
  return casacore::MVTime(casacore::Quantity(start_s, "s")).string(casacore::MVTime::FITS, 9);
}

void describe_band(const std::vector<Setup>& setups, imager::Observation& observation) {
  double lowest = std::numeric_limits<double>::infinity(), highest = 0;
  observation.spectral_frame = setups.front().spectral_frame;
  for (const Setup& setup : setups) {
    if (setup.spectral_frame != observation.spectral_frame) observation.spectral_frame.clear();
    for (std::size_t c = 0; c < setup.frequency_hz.size(); ++c) {
      lowest = std::min(lowest, setup.frequency_hz[c] - setup.channel_width_hz[c] / 2);
      highest = std::max(highest, setup.frequency_hz[c] + setup.channel_width_hz[c] / 2);
    }
  }
  observation.frequency_hz = (lowest + highest) / 2;
  observation.bandwidth_hz = highest - lowest;
}

}  // namespace

std::string telescope_name(const casacore::MeasurementSet& set, std::uint64_t row) {
  const int observation = cell_or<int>(set, "OBSERVATION_ID", static_cast<casacore::Int64>(row), -1);
  return cell_or<casacore::String>(set.observation(), "TELESCOPE_NAME", observation, "");
}

imager::Observation describe(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected) {
  const int first_field = casacore::ScalarColumn<int>(set, "FIELD_ID")(selected.first_row);
  const FieldCentre centre =
      selected.phase_centre ? field_centre(set, path, first_field, selected.first_row) : common_centre(set, path, selected);
  imager::Observation observation;
  observation.phase_centre = selected.phase_centre.value_or(centre.direction);
  observation.object = centre.name;
  describe_band(selected.setups, observation);
  translated("cannot read what " + path + " says of its observation", [&] {
    const int id = cell_or<int>(set, "OBSERVATION_ID", static_cast<casacore::Int64>(selected.first_row), -1);
    observation.telescope = telescope_name(set, selected.first_row);
    observation.observer = cell_or<casacore::String>(set.observation(), "OBSERVER", id, "");
    observation.date_obs = start_time(set, selected.first_row);
  });
  return observation;
}

imager::Observation joined(const std::vector<imager::Observation>& observations, const std::vector<std::string>& paths) {
  imager::Observation all = observations.front();
  double lowest = all.frequency_hz - all.bandwidth_hz / 2, highest = all.frequency_hz + all.bandwidth_hz / 2;
  for (std::size_t i = 1; i < observations.size(); ++i) {
    const imager::Observation& one = observations[i];
    if (const double apart = separation_rad(all.phase_centre, one.phase_centre); apart > same_centre_rad) {
      std::ostringstream message;
      message << paths.front() << " (field " << all.object << ") and " << paths[i] << " (field " << one.object
              << ") have phase centres " << apart << " rad apart; shift all to one with --phasecenter";
      throw std::runtime_error(message.str());
    }
    if (one.spectral_frame != all.spectral_frame) all.spectral_frame.clear();
    lowest = std::min(lowest, one.frequency_hz - one.bandwidth_hz / 2);
    highest = std::max(highest, one.frequency_hz + one.bandwidth_hz / 2);
  }
  if (observations.size() == 1) return all;
  all.frequency_hz = (lowest + highest) / 2;
  all.bandwidth_hz = highest - lowest;
  return all;
}

}  // namespace misfit::ms_io
