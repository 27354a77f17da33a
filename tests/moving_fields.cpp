#include "tests/moving_fields.h"

#include <casacore/casa/Arrays/ArrayMath.h>
#include <casacore/casa/Arrays/Matrix.h>
#include <casacore/casa/Logging/LogSink.h>
#include <casacore/casa/Logging/NullLogSink.h>
#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MDirection.h>
#include <casacore/measures/Measures/MEpoch.h>
#include <casacore/measures/Measures/MPosition.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/Measures/MeasFrame.h>
#include <casacore/measures/Measures/MeasTable.h>
#include <casacore/measures/TableMeasures/ArrayMeasColumn.h>
#include <casacore/ms/MeasurementSets/MSFieldColumns.h>
#include <casacore/ms/MeasurementSets/MeasurementSet.h>
#include <casacore/tables/Tables/ScaColDesc.h>
#include <casacore/tables/Tables/ScalarColumn.h>
#include <casacore/tables/Tables/SetupNewTab.h>
#include <casacore/tables/Tables/TableRecord.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <mutex>
#include <optional>

namespace misfit::testing {
namespace {

using casacore::MDirection;

constexpr double degree = 3.14159265358979323846 / 180, day_s = 86400;
constexpr double ra_rate = 2 * degree / day_s, dec_rate = 0.5 * degree / day_s;
constexpr double ra_acceleration = 4e-11, dec_acceleration = -2e-11;  // rad/s²: 50 arcsec in a quarter of an hour

casacore::MeasurementSet opened(const std::string& set) {
  return casacore::MeasurementSet(set, casacore::Table::Update);
}

std::optional<MDirection::Types> own_frame(Path path) {
  if (path == Path::azimuth) return MDirection::AZELGEO;
  if (path == Path::hour_angle) return MDirection::HADEC;
  if (path == Path::apparent) return MDirection::APP;
  return {};
}

/// Of the VLA.
casacore::MeasFrame frame_at(double time_s) {
  static std::once_flag silent;  // of tables that are missing, which the project's own conversions lack as well
  std::call_once(silent, [] {
    casacore::LogSinkInterface* sink = new casacore::NullLogSink;  // owned by casacore from here on
    casacore::LogSink::globalSink(sink);
  });
  casacore::MPosition place;
  casacore::MeasTable::Observatory(place, "VLA");
  return {casacore::MEpoch(casacore::MVEpoch(casacore::Quantity(time_s, "s")), casacore::MEpoch::UTC), place};
}

SkyPoint converted(const SkyPoint& point, MDirection::Types from, MDirection::Types to, double time_s) {
  const MDirection direction(casacore::MVDirection(point.ra_rad, point.dec_rad), from);
  const casacore::Vector<double> angles =
      MDirection::Convert(direction, MDirection::Ref(to, frame_at(time_s)))().getAngle().getValue();
  return {angles(0), angles(1)};
}

casacore::Matrix<double> matrix_of(const std::vector<SkyPoint>& points) {
  casacore::Matrix<double> matrix(2, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    matrix(0, i) = points[i].ra_rad;
    matrix(1, i) = points[i].dec_rad;
  }
  return matrix;
}

void put_directions(casacore::MSFieldColumns& columns, int field, const std::vector<SkyPoint>& points) {
  const auto row = static_cast<casacore::rownr_t>(field);
  columns.numPoly().put(row, static_cast<int>(points.size()) - 1);
  for (auto* const column : {&columns.phaseDir(), &columns.delayDir(), &columns.referenceDir()})
    column->put(row, matrix_of(points));
}

void put_frame(casacore::MSFieldColumns& columns, MDirection::Types frame) {
  for (auto* const column : {&columns.phaseDirMeasCol(), &columns.delayDirMeasCol(), &columns.referenceDirMeasCol()})
    column->setDescRefCode(frame, false);
}

/// Places half an hour apart: a straight line between them, as casacore would draw it, errs by 3e-8 rad.
void write_ephemeris_table(const std::string& path, const MovingField& field) {
  constexpr int rows = 97;
  constexpr double step_d = 1.0 / 48;
  casacore::TableDesc description;
  for (const char* const column : {"MJD", "RA", "DEC", "Rho", "RadVel"})
    description.addColumn(casacore::ScalarColumnDesc<double>(column));
  casacore::SetupNewTable made(path, description, casacore::Table::New);
  casacore::Table table(made, rows);
  const double first_d = field.middle_s() / day_s - rows / 2 * step_d;
  for (int r = 0; r < rows; ++r) {
    const auto row = static_cast<casacore::rownr_t>(r);
    const double mjd = first_d + r * step_d;
    const SkyPoint at = field.at(mjd * day_s);
    casacore::ScalarColumn<double>(table, "MJD").put(row, mjd);
    casacore::ScalarColumn<double>(table, "RA").put(row, at.ra_rad / degree);
    casacore::ScalarColumn<double>(table, "DEC").put(row, at.dec_rad / degree);
    casacore::ScalarColumn<double>(table, "Rho").put(row, 5000);
    casacore::ScalarColumn<double>(table, "RadVel").put(row, 0);
  }
  casacore::TableRecord& keywords = table.rwKeywordSet();
  for (const auto& [name, value] : {std::pair<const char*, double>{"MJD0", first_d - step_d},
                                    {"dMJD", step_d},
                                    {"GeoLong", 0},
                                    {"GeoLat", 0},
                                    {"GeoDist", 0}})
    keywords.define(name, value);
  for (const auto& [name, value] : {std::pair<const char*, const char*>{"NAME", "Object"},
                                    {"VS_CREATE", "2014/12/01/00:00"},
                                    {"VS_DATE", "2014/12/01/00:00"},
                                    {"VS_TYPE", "Table of comet/planetary positions"},
                                    {"VS_VERSION", "0001.0001"},
                                    {"posrefsys", "ICRF/ICRS"},
                                    {"obsloc", "GEOCENTRIC"}})
    keywords.define(name, casacore::String(value));
  table.tableInfo().setType("IERS");
  table.flushTableInfo();
}

/// As the conventions of the project have it: l to the east, m to the north.
std::array<double, 3> cosines(const SkyPoint& source, const SkyPoint& centre) {
  const double east = source.ra_rad - centre.ra_rad;
  const double l = std::cos(source.dec_rad) * std::sin(east);
  const double m = std::sin(source.dec_rad) * std::cos(centre.dec_rad) -
                   std::cos(source.dec_rad) * std::sin(centre.dec_rad) * std::cos(east);
  return {l, m, -(l * l + m * m) / (1 + std::sqrt(1 - l * l - m * m))};
}

}  // namespace

const char* name_of(Path path) {
  constexpr std::array<const char*, 6> names{"ephemeris", "NUM_POLY 1", "NUM_POLY 2", "AZELGEO", "HADEC", "APP"};
  return names[static_cast<std::size_t>(path)];
}

const char* frame_of(Path path) {
  return path == Path::ephemeris ? "ICRS" : "FK5";
}

MovingField::MovingField(const std::string& set, int field, Path path, const SkyPoint& about)
    : field_(field), path_(path), about_(about) {
  const auto [first_s, last_s] = time_range_s(set);
  middle_s_ = (first_s + last_s) / 2;
  if (path == Path::ephemeris) write_ephemeris(set);
  if (path == Path::rate) write_polynomial(set, 1);
  if (path == Path::acceleration) write_polynomial(set, 2);
  if (own_frame(path)) write_direction(set);
}

SkyPoint MovingField::at(double time_s) const {
  const double past_s = time_s - middle_s_;
  if (const auto frame = own_frame(path_)) {
    const SkyPoint own = converted(about_, MDirection::J2000, *frame, middle_s_);
    return converted(own, *frame, MDirection::J2000, time_s);
  }
  const double square_s = path_ == Path::acceleration ? past_s * past_s : 0;
  return {about_.ra_rad + ra_rate * past_s + ra_acceleration * square_s,
          about_.dec_rad + dec_rate * past_s + dec_acceleration * square_s};
}

void MovingField::write_polynomial(const std::string& set, int powers) const {
  casacore::MeasurementSet open = opened(set);
  casacore::MSFieldColumns columns(open.field());
  std::vector<SkyPoint> terms{about_, {ra_rate, dec_rate}};
  if (powers == 2) terms.push_back({ra_acceleration, dec_acceleration});
  put_directions(columns, field_, terms);
  columns.time().put(static_cast<casacore::rownr_t>(field_), middle_s_);
}

void MovingField::write_ephemeris(const std::string& set) const {
  casacore::MeasurementSet open = opened(set);
  casacore::Table field(open.field());
  if (!field.tableDesc().isColumn("EPHEMERIS_ID")) {
    field.addColumn(casacore::ScalarColumnDesc<int>("EPHEMERIS_ID"));
    casacore::ScalarColumn<int>(field, "EPHEMERIS_ID").fillColumn(-1);
  }
  write_ephemeris_table(set + "/FIELD/EPHEM" + std::to_string(field_) + "_Object.tab", *this);
  casacore::ScalarColumn<int>(field, "EPHEMERIS_ID").put(static_cast<casacore::rownr_t>(field_), field_);
  casacore::MSFieldColumns columns(open.field());
  put_frame(columns, MDirection::ICRS);
  put_directions(columns, field_, {{0, 0}});
}

void MovingField::write_direction(const std::string& set) const {
  casacore::MeasurementSet open = opened(set);
  casacore::MSFieldColumns columns(open.field());
  const auto frame = *own_frame(path_);
  casacore::ScalarColumn<casacore::String>(open.observation(), "TELESCOPE_NAME").put(0, "VLA");
  put_frame(columns, frame);
  put_directions(columns, field_, {converted(about_, MDirection::J2000, frame, middle_s_)});
}

void add_still_field(const std::string& set, const SkyPoint& at) {
  casacore::MeasurementSet open = opened(set);
  const auto field = static_cast<int>(open.field().nrow());
  open.field().addRow(1);
  casacore::MSFieldColumns columns(open.field());
  columns.name().put(static_cast<casacore::rownr_t>(field), "STILL");
  put_directions(columns, field, {at});
  if (!columns.ephemerisId().isNull()) columns.ephemerisId().put(static_cast<casacore::rownr_t>(field), -1);
  const casacore::ScalarColumn<double> time(open, "TIME");
  casacore::ScalarColumn<int> id(open, "FIELD_ID");
  const double interval_s = casacore::ScalarColumn<double>(open, "INTERVAL")(0);
  for (casacore::rownr_t row = 0; row < open.nrow(); ++row)
    if (std::lround((time(row) - time(0)) / interval_s) % 2 == 1) id.put(row, field);
}

void put_fixed_source(const std::string& set, const std::vector<MovingField>& moving, const SkyPoint& source, double flux_jy) {
  constexpr double light_m_s = 299792458;
  casacore::MeasurementSet open = opened(set);
  const casacore::ArrayColumn<double> frequency(open.spectralWindow(), "CHAN_FREQ");
  const casacore::ScalarColumn<int> window(open.dataDescription(), "SPECTRAL_WINDOW_ID"), description(open, "DATA_DESC_ID");
  const casacore::ScalarColumn<double> time(open, "TIME");
  const casacore::ScalarColumn<int> field(open, "FIELD_ID");
  const casacore::ArrayColumn<double> uvw_column(open, "UVW"), direction(open.field(), "PHASE_DIR");
  casacore::ArrayColumn<casacore::Complex> data(open, "DATA");
  for (casacore::rownr_t row = 0; row < open.nrow(); ++row) {
    const auto moves = std::find_if(moving.begin(), moving.end(), [&](const auto& one) { return one.field() == field(row); });
    const casacore::Array<double> still = direction(static_cast<casacore::rownr_t>(field(row)));
    const SkyPoint centre = moves != moving.end() ? moves->at(time(row)) : SkyPoint{still.data()[0], still.data()[1]};
    const std::array<double, 3> lmn = cosines(source, centre);
    const casacore::Array<double> uvw = uvw_column(row);
    const int id = window(static_cast<casacore::rownr_t>(description(row)));
    const casacore::Vector<double> hz = frequency(static_cast<casacore::rownr_t>(id));
    const double delay_s = (uvw.data()[0] * lmn[0] + uvw.data()[1] * lmn[1] + uvw.data()[2] * lmn[2]) / light_m_s;
    casacore::Matrix<casacore::Complex> cell(2, hz.size());
    for (std::size_t c = 0; c < hz.size(); ++c)
      cell(0, c) = cell(1, c) = casacore::Complex(std::polar(flux_jy, 360 * degree * std::remainder(delay_s * hz(c), 1.0)));
    data.put(row, cell);
  }
}

void move_times(const std::string& set, double by_s) {
  casacore::MeasurementSet open = opened(set);
  for (const char* const name : {"TIME", "TIME_CENTROID"}) {
    casacore::ScalarColumn<double> column(open, name);
    for (casacore::rownr_t row = 0; row < open.nrow(); ++row) column.put(row, column(row) + by_s);
  }
}

std::array<double, 2> time_range_s(const std::string& set) {
  const casacore::MeasurementSet open(set);
  const casacore::Vector<double> time = casacore::ScalarColumn<double>(open, "TIME").getColumn();
  return {casacore::min(time), casacore::max(time)};
}

}  // namespace misfit::testing
