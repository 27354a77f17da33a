#include <casacore/casa/Quanta/MVTime.h>
#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MCEpoch.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/Measures/MeasFrame.h>
#include <casacore/measures/Measures/MeasTable.h>
#include <casacore/ms/MeasurementSets/MSAntennaColumns.h>
#include <casacore/ms/MeasurementSets/MSFieldColumns.h>
#include <casacore/ms/MeasurementSets/MSObservation.h>
#include <casacore/tables/TaQL/TableParse.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "ms_io/metadata_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

constexpr double same_centre_rad = 1e-9;

/// The cell of a scalar column, or `otherwise` when the row or the column does not exist.
template <typename T>
T cell_or(const casacore::Table& table, const char* column, casacore::Int64 row, const T& otherwise) {
  if (row < 0 || static_cast<casacore::rownr_t>(row) >= table.nrow() || !table.tableDesc().isColumn(column)) return otherwise;
  return casacore::ScalarColumn<T>(table, column)(static_cast<casacore::rownr_t>(row));
}

std::string telescope_name(const casacore::MeasurementSet& set, std::uint64_t row) {
  const int observation = cell_or<int>(set, "OBSERVATION_ID", static_cast<casacore::Int64>(row), -1);
  return cell_or<casacore::String>(set.observation(), "TELESCOPE_NAME", observation, "");
}

/// When and where the row was observed.
casacore::MeasFrame frame_of(const casacore::MeasurementSet& set, std::uint64_t row) {
  casacore::MeasFrame frame(casacore::ScalarMeasColumn<casacore::MEpoch>(set, "TIME")(row));
  casacore::MPosition position;
  if (!casacore::MeasTable::Observatory(position, telescope_name(set, row)) && set.antenna().nrow() > 0) {
    position = casacore::MSAntennaColumns(set.antenna()).positionMeas()(0);
  }
  frame.set(position);
  return frame;
}

struct FieldCentre {
  int field = 0;
  std::string name;
  casacore::MDirection direction;  ///< J2000, ICRS or B1950
};

FieldCentre field_centre(const casacore::MeasurementSet& set, const std::string& path, int field, std::uint64_t row) {
  if (field < 0 || static_cast<casacore::rownr_t>(field) >= set.field().nrow()) {
    throw std::runtime_error(path + " has rows with FIELD_ID " + std::to_string(field) + ", but FIELD has " +
                             std::to_string(set.field().nrow()) + " rows");
  }
  return translated("cannot find the phase centre of field " + std::to_string(field) + " of " + path, [&] {
    const casacore::MSFieldColumns columns(set.field());
    const auto index = static_cast<casacore::rownr_t>(field);
    const double time = casacore::ScalarColumn<double>(set, "TIME")(row);
    casacore::MDirection direction = columns.phaseDirMeas(index, time);
    const auto frame = casacore::MDirection::castType(direction.getRef().getType());
    if (frame != casacore::MDirection::J2000 && frame != casacore::MDirection::ICRS && frame != casacore::MDirection::B1950) {
      direction = casacore::MDirection::Convert(direction,
                                                casacore::MDirection::Ref(casacore::MDirection::J2000, frame_of(set, row)))();
    }
    return FieldCentre{field, columns.name()(index), direction};
  });
}

double separation(const FieldCentre& a, const FieldCentre& b) {
  const casacore::MDirection same_frame = casacore::MDirection::Convert(b.direction, a.direction.getRef())();
  return a.direction.getValue().separation(same_frame.getValue());
}

std::string label(const FieldCentre& centre) {
  return std::to_string(centre.field) + " (" + centre.name + ")";
}

FieldCentre common_centre(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected) {
  std::vector<FieldCentre> centres;
  for (const auto& [field, row] : selected.first_row_of_field) centres.push_back(field_centre(set, path, field, row));
  for (const FieldCentre& centre : centres) {
    const double apart = separation(centres.front(), centre);
    if (apart <= same_centre_rad) continue;
    std::ostringstream message;
    message << path << ": fields " << label(centres.front()) << " and " << label(centre) << " have phase centres " << apart
            << " rad apart; select one with --field";
    throw std::runtime_error(message.str());
  }
  const int field_of_first_row = casacore::ScalarColumn<int>(set, "FIELD_ID")(selected.first_row);
  return *std::find_if(centres.begin(), centres.end(), [&](const auto& centre) { return centre.field == field_of_first_row; });
}

imager::SkyDirection sky_direction(const casacore::MDirection& direction) {
  constexpr double turn = 2 * 3.14159265358979323846;
  const auto& angles = direction.getValue();
  imager::SkyDirection sky;
  sky.ra_rad = angles.getLong() < 0 ? angles.getLong() + turn : angles.getLong();
  sky.dec_rad = angles.getLat();
  const auto frame = casacore::MDirection::castType(direction.getRef().getType());
  sky.frame = frame == casacore::MDirection::ICRS ? "ICRS" : frame == casacore::MDirection::B1950 ? "FK4" : "FK5";
  return sky;
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

imager::Observation describe(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected) {
  const FieldCentre centre = common_centre(set, path, selected);
  imager::Observation observation;
  observation.phase_centre = sky_direction(centre.direction);
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

}  // namespace misfit::ms_io
