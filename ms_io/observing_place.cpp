#include <casacore/measures/Measures/MEpoch.h>
#include <casacore/measures/Measures/MeasTable.h>
#include <casacore/measures/TableMeasures/ScalarMeasColumn.h>
#include <casacore/ms/MeasurementSets/MSAntennaColumns.h>
#include <casacore/tables/Tables/ArrayColumn.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>
#include <utility>

#include "ms_io/metadata_internal.h"
#include "ms_io/observing_place_internal.h"

namespace misfit::ms_io {
namespace {

/// The Earth's polar radius is 6 356 752 m, and no antenna stands far below that.
constexpr double least_radius_m = 6.3e6;

double radius_m(const casacore::MPosition& position) {
  const casacore::Vector<double> xyz_m = position.getValue().getValue();
  return std::hypot(xyz_m(0), xyz_m(1), xyz_m(2));
}

/// Telescopes that casacore knows by another name.
constexpr std::pair<const char*, const char*> other_names[] = {{"EVLA", "VLA"}, {"JVLA", "VLA"},       {"ACA", "ALMA"},
                                                               {"OSF", "ALMA"}, {"EMERLIN", "Lovell"}, {"e-MERLIN", "Lovell"}};

bool known_by_another_name(const std::string& telescope, casacore::MPosition& position) {
  return std::any_of(std::begin(other_names), std::end(other_names), [&](const auto& names) {
    return telescope == names.first && casacore::MeasTable::Observatory(position, names.second);
  });
}

std::string doubt_of(const std::string& telescope, const casacore::MSAntennaColumns& antennas) {
  std::ostringstream doubt;
  doubt << "casacore does not know where a telescope '" << telescope << "' stands, and ";
  if (antennas.nrow() == 0) {
    doubt << "ANTENNA has no rows";
  } else {
    doubt << "POSITION of antenna 0 (" << antennas.name()(0) << ") is " << radius_m(antennas.positionMeas()(0))
          << " m from the middle of the Earth, expected some 6371000 m";
  }
  return doubt.str();
}

}  // namespace

ObservingPlace observing_place(const casacore::MeasurementSet& set, std::uint64_t row) {
  ObservingPlace place;
  const std::string telescope = telescope_name(set, row);
  if (casacore::MeasTable::Observatory(place.position, telescope)) return place;
  const casacore::MSAntennaColumns antennas(set.antenna());
  for (casacore::rownr_t a = 0; a < antennas.nrow(); ++a) {
    place.position = antennas.positionMeas()(a);
    if (radius_m(place.position) >= least_radius_m) return place;
  }
  if (known_by_another_name(telescope, place.position)) return place;
  if (antennas.nrow() > 0) place.position = antennas.positionMeas()(0);
  place.doubt = doubt_of(telescope, antennas);
  return place;
}

casacore::MeasFrame frame_of(const casacore::MeasurementSet& set, std::uint64_t row) {
  casacore::MeasFrame frame(casacore::ScalarMeasColumn<casacore::MEpoch>(set, "TIME")(row));
  frame.set(observing_place(set, row).position);
  return frame;
}

double largest_baseline_m(const casacore::MeasurementSet& set) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const casacore::ArrayColumn<double> position(set.antenna(), "POSITION");
  double low[3] = {infinite, infinite, infinite}, high[3] = {-infinite, -infinite, -infinite};
  for (casacore::rownr_t a = 0; a < set.antenna().nrow(); ++a) {
    const casacore::Vector<double> xyz_m = position(a);
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], xyz_m(i));
      high[i] = std::max(high[i], xyz_m(i));
    }
  }
  const double length_m = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  return std::isfinite(length_m) ? length_m : 0;
}

}  // namespace misfit::ms_io
