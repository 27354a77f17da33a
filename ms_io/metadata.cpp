#include <casacore/casa/Quanta/MVTime.h>
#include <casacore/measures/Measures/MCEpoch.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/TableMeasures/ScalarMeasColumn.h>
#include <casacore/ms/MeasurementSets/MSObservation.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ms_io/field_centres_internal.h"
#include "ms_io/followed_field_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

/// The cell of a scalar column, or `otherwise` when the row or the column does not exist.
template <typename T>
T cell_or(const casacore::Table& table, const char* column, casacore::Int64 row, const T& otherwise) {
  if (row < 0 || static_cast<casacore::rownr_t>(row) >= table.nrow() || !table.tableDesc().isColumn(column)) return otherwise;
  return casacore::ScalarColumn<T>(table, column)(static_cast<casacore::rownr_t>(row));
}

/// The start of the integration of `row`, UTC.
std::string start_time(const casacore::MeasurementSet& set, std::uint64_t row) {
  const casacore::MEpoch middle = casacore::ScalarMeasColumn<casacore::MEpoch>(set, "TIME")(row);
  const double start_s = utc_s(middle) - casacore::ScalarColumn<double>(set, "INTERVAL")(row) / 2;
  return utc_text(start_s);
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

int observation_of(const casacore::MeasurementSet& set, std::uint64_t row) {
  return cell_or<int>(set, "OBSERVATION_ID", static_cast<casacore::Int64>(row), -1);
}

std::string telescope_name(const casacore::MeasurementSet& set, int observation) {
  return cell_or<casacore::String>(set.observation(), "TELESCOPE_NAME", observation, "");
}

double utc_s(const casacore::MEpoch& time) {
  return casacore::MEpoch::Convert(time, casacore::MEpoch::UTC)().get("s").getValue();
}

std::string utc_text(double utc_s) {
  if (!std::isfinite(utc_s)) return "";
  return casacore::MVTime(casacore::Quantity(utc_s, "s")).string(casacore::MVTime::FITS, 9);
}

void centre_on_field(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected, double time_s,
                     imager::Observation& observation) {
  FieldDirections fields(set, path, selected.body);
  const FieldCentre centre = followed_centre(fields, selected, first_field(set, selected), {time_s, selected.first_row});
  observation.phase_centre = centre.direction;
  observation.moving_at = utc_text(utc_s(centre.observed));
}

imager::Observation describe(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected) {
  const int field = first_field(set, selected);
  imager::Observation observation;
  observation.object = translated("cannot read FIELD of " + path, [&] { return FieldDirections(set, path).name(field); });
  if (selected.phase_centre) {
    observation.phase_centre = *selected.phase_centre;
  } else if (selected.follows_field) {
    centre_on_field(set, path, selected, moving_span(selected).middle_s(), observation);
  } else {
    observation.phase_centre = field_centre(set, path, field, selected.first_row).direction;
  }
  describe_band(selected.setups, observation);
  translated("cannot read what " + path + " says of its observation", [&] {
    const int id = observation_of(set, selected.first_row);
    observation.telescope = telescope_name(set, id);
    observation.observer = cell_or<casacore::String>(set.observation(), "OBSERVER", id, "");
    observation.date_obs = start_time(set, selected.first_row);
  });
  return observation;
}

imager::Observation joined(const OpenSets& sets) {
  std::vector<imager::Observation> observations;
  for (const auto& set : sets) observations.push_back(describe(set->set, set->path, set->selected));
  imager::Observation all = observations.front();
  double lowest = all.frequency_hz - all.bandwidth_hz / 2, highest = all.frequency_hz + all.bandwidth_hz / 2;
  for (std::size_t i = 1; i < observations.size(); ++i) {
    const imager::Observation& one = observations[i];
    const auto both = [&] {
      return sets.front()->path + " (field " + all.object + ") and " + sets[i]->path + " (field " + one.object + ") ";
    };
    if (all.moving_at.empty() != one.moving_at.empty())
      throw std::runtime_error(
          both() + "differ: the phase centre of one moves, and one stands still; shift all to one with --phasecenter");
    const double apart = all.moving_at.empty() ? separation_rad(all.phase_centre, one.phase_centre) : 0;
    if (apart > same_centre_rad)
      throw std::runtime_error(both() + "have phase centres " + angle_words(apart) +
                               " apart; shift all to one with --phasecenter");
    if (one.spectral_frame != all.spectral_frame) all.spectral_frame.clear();
    lowest = std::min(lowest, one.frequency_hz - one.bandwidth_hz / 2);
    highest = std::max(highest, one.frequency_hz + one.bandwidth_hz / 2);
  }
  if (observations.size() == 1) return all;
  if (!all.moving_at.empty()) follow_one_target(sets, all);
  all.frequency_hz = (lowest + highest) / 2;
  all.bandwidth_hz = highest - lowest;
  return all;
}

}  // namespace misfit::ms_io
