#include <casacore/measures/Measures/MCPosition.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/Measures/MeasTable.h>
#include <casacore/ms/MeasurementSets/MSAntennaColumns.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "ms_io/capitals.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/observing_place_internal.h"

namespace misfit::ms_io {
namespace {

using casacore::MPosition;
using Point = std::array<double, 3>;  // ITRF, m

/// Antennas whose distance from the Earth's middle lies between these have a place: the Earth's radius is 6 357 km at the poles
/// and 6 378 km at the equator.
constexpr double least_radius_m = 6.3e6, most_radius_m = 6.5e6;

Point point_of(const MPosition& position) {
  const casacore::MVPosition itrf = MPosition::Convert(position, MPosition::ITRF)().getValue();
  return {itrf(0), itrf(1), itrf(2)};
}

double distance_m(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double radius_m(const Point& point) {
  return distance_m(point, {});
}

/// Capitals and digits of a telescope's name, by which it is known.
std::string bare(const std::string& name) {
  std::string letters;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) letters += c;
  return capitals(letters);
}

/// Telescopes that casacore knows by another name.
constexpr std::pair<const char*, const char*> other_names[] = {
    {"EVLA", "VLA"},        {"JVLA", "VLA"},   {"ACA", "ALMA"},   {"OSF", "ALMA"},      {"EMERLIN", "Lovell"},
    {"MERLIN", "Lovell"},   {"UGMRT", "GMRT"}, {"PDBI", "NOEMA"}, {"IRAMPDB", "NOEMA"}, {"SKAMID", "MeerKAT"},
    {"SKA1MID", "MeerKAT"}, {"SKALOW", "MWA"}, {"SKA1LOW", "MWA"}};

/// The place of a telescope by its whole name: casacore alone would also take SKA1-MID for SKA, and K for KVN.
std::optional<MPosition> place_by_name(const std::string& telescope) {
  std::string name = bare(telescope);
  for (const auto& [other, known] : other_names)
    if (name == other) name = bare(known);
  MPosition position;
  for (const casacore::String& known : casacore::MeasTable::Observatories())
    if (!name.empty() && name == bare(known) && casacore::MeasTable::Observatory(position, known)) return position;
  return {};
}

bool of_several_telescopes(const casacore::MeasurementSet& set) {
  std::set<std::string> names;
  for (int observation = 0; observation < static_cast<int>(set.observation().nrow()); ++observation)
    names.insert(telescope_name(set, observation));
  return names.size() > 1;
}

/// The antennas in rows of an observation.
std::set<casacore::rownr_t> antennas_of(const casacore::MeasurementSet& set, int observation) {
  std::set<casacore::rownr_t> antennas;
  const auto ids = [&](const char* column) { return casacore::ScalarColumn<int>(set, column).getColumn().tovector(); };
  const std::vector<int> of = ids("OBSERVATION_ID"), one = ids("ANTENNA1"), other = ids("ANTENNA2");
  for (std::size_t row = 0; row < of.size(); ++row)
    if (of[row] == observation)
      for (const int antenna : {one[row], other[row]})
        if (antenna >= 0) antennas.insert(static_cast<casacore::rownr_t>(antenna));
  return antennas;
}

/// The places of the antennas in `some` that have one.
template <typename Some>
std::vector<Point> standing(const casacore::MSAntennaColumns& antennas, const Some& some) {
  std::vector<Point> points;
  for (casacore::rownr_t a = 0; a < antennas.nrow(); ++a) {
    if (!some(a)) continue;
    const Point point = point_of(antennas.positionMeas()(a));
    if (radius_m(point) >= least_radius_m && radius_m(point) <= most_radius_m) points.push_back(point);
  }
  return points;
}

/// The median, axis by axis.
Point median(const std::vector<Point>& points) {
  Point middle{};
  for (std::size_t axis = 0; axis < middle.size(); ++axis) {
    std::vector<double> values;
    for (const Point& point : points) values.push_back(point[axis]);
    std::sort(values.begin(), values.end());
    middle[axis] = (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
  }
  return middle;
}

std::string doubt_of(const std::string& telescope, const casacore::MSAntennaColumns& antennas) {
  std::ostringstream doubt;
  doubt << "casacore does not know where a telescope '" << telescope << "' stands, and ";
  if (antennas.nrow() == 0) {
    doubt << "ANTENNA has no rows";
  } else {
    doubt << "POSITION of antenna 0 (" << antennas.name()(0) << ") is " << radius_m(point_of(antennas.positionMeas()(0)))
          << " m from the middle of the Earth, expected some 6371000 m";
  }
  return doubt.str();
}

std::string dispute_of(const std::string& telescope, double apart_m) {
  return "TELESCOPE_NAME is '" + telescope + "', which casacore places " + std::to_string(std::lround(apart_m / 1e3)) +
         " km from the antennas' POSITION: the antennas' positions are used";
}

}  // namespace

ObservingPlace observing_place(const casacore::MeasurementSet& set, int observation) {
  constexpr double beside_m = 50e3;
  ObservingPlace place;
  const std::string telescope = telescope_name(set, observation);
  const std::optional<MPosition> named = place_by_name(telescope);
  if (named) place.position = *named;
  const bool several = of_several_telescopes(set);
  if (named && several) return place;
  const casacore::MSAntennaColumns antennas(set.antenna());
  const std::set<casacore::rownr_t> own = several ? antennas_of(set, observation) : std::set<casacore::rownr_t>();
  const std::vector<Point> points = standing(antennas, [&](casacore::rownr_t a) { return !several || own.count(a) > 0; });
  if (points.empty()) {
    if (!named) place.doubt = doubt_of(telescope, antennas);
    return place;
  }
  const Point middle = median(points);
  double near_m = beside_m;
  for (const Point& point : points) near_m = std::max(near_m, distance_m(point, middle));
  const double apart_m = named ? distance_m(point_of(*named), middle) : 0;
  if (named && apart_m <= near_m) return place;
  if (named) place.dispute = dispute_of(telescope, apart_m);
  place.position = MPosition(casacore::MVPosition(middle[0], middle[1], middle[2]), MPosition::ITRF);
  place.of_antennas = true;
  return place;
}

std::optional<MPosition> antenna_place(const casacore::MeasurementSet& set, int antenna, const ObservingPlace& telescope) {
  const casacore::MSAntennaColumns antennas(set.antenna());
  const std::vector<Point> own =
      standing(antennas, [&](casacore::rownr_t a) { return a == static_cast<casacore::rownr_t>(antenna); });
  if (!own.empty()) return MPosition(casacore::MVPosition(own[0][0], own[0][1], own[0][2]), MPosition::ITRF);
  if (!telescope.doubt.empty()) return {};
  return telescope.position;
}

bool in_one_place(const casacore::MeasurementSet& set, const std::set<int>& observations) {
  constexpr double apart_m = 1e3;
  const Point first = point_of(observing_place(set, *observations.begin()).position);
  return std::all_of(observations.begin(), observations.end(), [&](int observation) {
    return distance_m(point_of(observing_place(set, observation).position), first) < apart_m;
  });
}

}  // namespace misfit::ms_io
