#include <casacore/casa/Quanta/MVDirection.h>
#include <casacore/casa/Quanta/Quantum.h>
#include <casacore/measures/Measures/MCEpoch.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/tables/Tables/ScalarColumn.h>
#include <casacore/tables/Tables/Table.h>
#include <casacore/tables/Tables/TableRecord.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <optional>
#include <sstream>
#include <utility>

#include "imager/numerics/constants.h"
#include "ms_io/ephemeris_internal.h"

namespace misfit::ms_io {
namespace {

using casacore::MDirection;

/// The unit of a column, by either keyword that programs write.
casacore::String unit_of(const casacore::TableRecord& keywords, const char* usual_unit) {
  if (keywords.isDefined("QuantumUnits")) return *keywords.asArrayString("QuantumUnits").begin();
  return keywords.isDefined("UNIT") ? keywords.asString("UNIT") : casacore::String(usual_unit);
}

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// The frame of a table, found as casacore does, except that casacore takes unknown frames for apparent places.
std::optional<MDirection::Types> frame_in(const casacore::TableRecord& keywords) {
  if (!keywords.isDefined("posrefsys"))
    return keywords.isDefined("GeoDist") && keywords.asDouble("GeoDist") != 0 ? MDirection::TOPO : MDirection::APP;
  casacore::String name = keywords.asString("posrefsys");
  name.upcase();
  constexpr std::pair<const char*, MDirection::Types> known[] = {{"J2000", MDirection::J2000},
                                                                 {"B1950", MDirection::B1950},
                                                                 {"APP", MDirection::APP},
                                                                 {"ICRS", MDirection::ICRS},
                                                                 {"TOPO", MDirection::TOPO}};
  for (const auto& [part, frame] : known)
    if (name.contains(part)) return frame;
  return {};
}

}  // namespace

Ephemeris::Ephemeris(const std::string& path) : path_(path) {
  const casacore::Table table(path, casacore::TableLock(casacore::TableLock::NoLocking));
  const std::optional<MDirection::Types> frame = frame_in(table.keywordSet());
  if (!frame)
    fail("is in the frame posrefsys '" + std::string(table.keywordSet().asString("posrefsys")) +
         "', expected one such as ICRF/ICRS, ICRF/J2000.0, B1950, APP or TOPO");
  frame_ = *frame;
  for (const char* const name : {"MJD", "RA", "DEC"})
    if (!table.tableDesc().isColumn(name)) fail("has no column " + std::string(name) + ", expected MJD, RA and DEC");
  mjd_ = values_of(table, {"MJD", "d", "d"});
  const std::vector<double> ra_rad = values_of(table, {"RA", "deg", "rad"}), dec_rad = values_of(table, {"DEC", "deg", "rad"});
  if (mjd_.size() < 2) fail("has " + std::to_string(mjd_.size()) + " rows, expected two or more");
  for (std::size_t row = 0; row < mjd_.size(); ++row) {
    if (!std::isfinite(mjd_[row]) || !std::isfinite(ra_rad[row]) || !std::isfinite(dec_rad[row]))
      fail("has numbers that are not finite in row " + std::to_string(row));
    if (row > 0 && !(mjd_[row] > mjd_[row - 1])) fail("is not in the order of MJD at row " + std::to_string(row));
    constexpr double turn = 2 * imager::pi;
    if (!(std::abs(dec_rad[row]) <= turn / 4 + 1e-9 && std::abs(ra_rad[row]) <= 2 * turn))
      fail("has RA " + number(ra_rad[row] * 360 / turn) + " and DEC " + number(dec_rad[row] * 360 / turn) + " degrees in row " +
           std::to_string(row) + ", expected RA within two turns and DEC from -90 to 90");
    direction_.push_back({std::cos(dec_rad[row]) * std::cos(ra_rad[row]), std::cos(dec_rad[row]) * std::sin(ra_rad[row]),
                          std::sin(dec_rad[row])});
  }
  const casacore::TableRecord& keywords = table.keywordSet();
  const double from_middle_km = keywords.isDefined("GeoDist") ? keywords.asDouble("GeoDist") : 0;
  if (!(from_middle_km >= 0)) fail("has GeoDist " + number(from_middle_km) + " km, expected 0 or more");
  geocentric_ = frame_ != MDirection::TOPO && from_middle_km == 0;
}

std::vector<double> Ephemeris::values_of(const casacore::Table& table, const Column& column) const {
  casacore::ScalarColumn<double> cells;
  casacore::Quantity unit;
  try {
    cells.attach(table, column.name);
    unit = casacore::Quantity(1, unit_of(cells.keywordSet(), column.usual_unit));
  } catch (const casacore::AipsError& error) {
    fail("has a column " + std::string(column.name) +
         " that cannot be read, expected one of double precision in a unit such as " + column.usual_unit + ": " +
         std::string(error.getMesg()));
  }
  if (!unit.isConform(column.wanted_unit))
    fail("has " + std::string(column.name) + " in " + std::string(unit.getUnit()) + ", expected a unit such as " +
         column.usual_unit);
  std::vector<double> values = cells.getColumn().tovector();
  for (double& value : values) value *= unit.getValue(column.wanted_unit);
  return values;
}

/// The values of a column, read when they are first asked for.
const std::vector<double>& Ephemeris::values_of(const Column& column) const {
  auto known = others_.find(column.name);
  if (known != others_.end()) return known->second;
  const casacore::Table table(path_, casacore::TableLock(casacore::TableLock::NoLocking));
  if (!table.tableDesc().isColumn(column.name)) fail("has no column " + std::string(column.name) + ", expected one");
  std::vector<double> values = values_of(table, column);
  if (values.size() != mjd_.size()) fail("changed while it was read");
  return others_.emplace(column.name, std::move(values)).first->second;
}

void Ephemeris::fail(const std::string& what) const {
  throw casacore::AipsError("its ephemeris " + path_ + " " + what);
}

Ephemeris::Stencil Ephemeris::stencil(double utc_mjd) const {
  if (!(utc_mjd >= mjd_.front() && utc_mjd <= mjd_.back())) {
    std::ostringstream what;
    what << std::setprecision(11) << "goes from MJD " << mjd_.front() << " to " << mjd_.back() << ", not to " << utc_mjd
         << "; --timerange selects rows within it";
    fail(what.str());
  }
  const std::size_t points = std::min<std::size_t>(4, mjd_.size());
  const auto next = static_cast<std::size_t>(std::upper_bound(mjd_.begin(), mjd_.end(), utc_mjd) - mjd_.begin());
  Stencil made{std::min(next - std::min<std::size_t>(next, points / 2), mjd_.size() - points), {}};
  for (std::size_t row = made.first; row < made.first + points; ++row) {
    double weight = 1;
    for (std::size_t other = made.first; other < made.first + points; ++other)
      if (other != row) weight *= (utc_mjd - mjd_[other]) / (mjd_[row] - mjd_[other]);
    made.weight.push_back(weight);
  }
  return made;
}

/// Evaluates a polynomial through unit vectors, and normalises it. For rows 5 degrees apart it errs by 0.2 arcsec.
MDirection Ephemeris::at(double utc_mjd) const {
  const Stencil rows = stencil(utc_mjd);
  for (std::size_t row = rows.first + 1; row < rows.first + rows.weight.size(); ++row) {
    constexpr double most_rad = 5 * imager::pi / 180;
    const std::array<double, 3>&one = direction_[row - 1], &next = direction_[row];
    const double apart_rad = 2 * std::asin(std::min(1.0, std::hypot(one[0] - next[0], one[1] - next[1], one[2] - next[2]) / 2));
    if (apart_rad > most_rad)
      fail("moves by " + number(apart_rad * 180 / imager::pi) + " degrees between rows " + std::to_string(row - 1) + " and " +
           std::to_string(row) + ", expected rows so near that it moves by no more than 5");
  }
  std::array<double, 3> sum{};
  for (std::size_t row = 0; row < rows.weight.size(); ++row)
    for (std::size_t i = 0; i < 3; ++i) sum[i] += rows.weight[row] * direction_[rows.first + row][i];
  casacore::MVDirection direction(sum[0], sum[1], sum[2]);
  direction.adjust();
  return {direction, frame_};
}

double Ephemeris::distance_m(double utc_mjd) const {
  constexpr double earth_m = 6.4e6;
  const double distance_m = interpolated({"Rho", "AU", "m"}, utc_mjd);
  if (!(distance_m > earth_m))
    fail("has Rho " + number(distance_m) + " m at MJD " + number(utc_mjd) + ", expected more than the Earth's radius");
  return distance_m;
}

double Ephemeris::recession_m_s(double utc_mjd) const {
  const double m_s = interpolated({"RadVel", "AU/d", "m/s"}, utc_mjd);
  if (!(std::abs(m_s) < imager::speed_of_light_m_s))
    fail("has RadVel " + number(m_s) + " m/s at MJD " + number(utc_mjd) + ", expected less than light's");
  return m_s;
}

double Ephemeris::interpolated(const Column& column, double utc_mjd) const {
  const std::vector<double>& values = values_of(column);
  const Stencil rows = stencil(utc_mjd);
  double sum = 0;
  for (std::size_t row = 0; row < rows.weight.size(); ++row) sum += rows.weight[row] * values[rows.first + row];
  if (!std::isfinite(sum)) fail("has values of " + std::string(column.name) + " that are not finite, expected finite ones");
  return sum;
}

double utc_mjd(const casacore::MEpoch& when) {
  return casacore::MEpoch::Convert(when, casacore::MEpoch::UTC)().get("d").getValue();
}

casacore::MSField without_ephemerides(const casacore::MSField& field) {
  constexpr const char* column = "EPHEMERIS_ID";
  if (!field.tableDesc().isColumn(column)) return field;
  std::vector<casacore::String> others;
  for (const casacore::String& name : field.tableDesc().columnNames())
    if (name != column) others.push_back(name);
  casacore::Block<casacore::String> names(others.size());
  std::copy(others.begin(), others.end(), names.begin());
  return casacore::MSField(field.project(names));
}

std::string ephemeris_path(const casacore::MSField& field, int ephemeris) {
  const std::string& folder = field.tableName();
  const std::string begin = "EPHEM" + std::to_string(ephemeris) + "_", end = ".tab";
  std::vector<std::string> found;
  std::error_code gone;
  for (std::filesystem::directory_iterator entry(folder, gone), none; !gone && entry != none; entry.increment(gone)) {
    const std::string name = entry->path().filename();
    if (name.size() > begin.size() + end.size() - 1 && name.compare(0, begin.size(), begin) == 0 &&
        name.compare(name.size() - end.size(), end.size(), end) == 0)
      found.push_back(entry->path());
  }
  if (found.size() == 1) return found.front();
  throw casacore::AipsError("its EPHEMERIS_ID is " + std::to_string(ephemeris) + ", and " + folder + " holds " +
                            std::to_string(found.size()) + " tables " + begin + "*" + end +
                            ", expected one, or EPHEMERIS_ID -1 and a direction of its own");
}

}  // namespace misfit::ms_io
