#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MCEpoch.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/TableMeasures/ArrayMeasColumn.h>
#include <casacore/measures/TableMeasures/ScalarMeasColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>
#include <casacore/tables/Tables/TableRecord.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include "imager/numerics/constants.h"
#include "ms_io/celestial_frame_internal.h"
#include "ms_io/field_directions_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/observing_place_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

using casacore::MDirection;

Motion motion_of(MDirection::Types frame) {
  switch (frame) {
    case MDirection::J2000:
    case MDirection::ICRS:
    case MDirection::B1950:
    case MDirection::B1950_VLA:
    case MDirection::GALACTIC:
    case MDirection::SUPERGAL:
    case MDirection::ECLIPTIC:
      return Motion::none;
    case MDirection::HADEC:
    case MDirection::AZEL:
    case MDirection::AZELSW:
    case MDirection::AZELGEO:
    case MDirection::AZELSWGEO:
    case MDirection::ITRF:
      return Motion::earth;
    default:
      return Motion::target;
  }
}

/// The frame of a cell.
MDirection::Types frame_of_cell(const casacore::ArrayMeasColumn<MDirection>& column, casacore::rownr_t row) {
  try {
    const casacore::Array<MDirection> directions = column(row);
    return MDirection::castType(directions.begin()->getRef().getType());
  } catch (const casacore::AipsError& error) {
    throw casacore::AipsError("its direction is in no frame that casacore knows: " + error.getMesg());
  }
}

/// Throws where a cell is no direction: casacore would take it for some direction.
void require_direction(const casacore::ArrayColumn<double>& cells, const std::vector<double>& values) {
  constexpr double turn = 2 * imager::pi, pole = turn / 4 + 1e-7;  // as single precision rounds it
  const casacore::TableRecord& keywords = cells.keywordSet();
  const casacore::String unit =
      keywords.isDefined("QuantumUnits") ? *keywords.asArrayString("QuantumUnits").begin() : casacore::String("rad");
  const double size = casacore::Quantity(1, unit).getValue("rad");
  if (std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }) &&
      std::abs(values[0] * size) <= 2 * turn && std::abs(values[1] * size) <= pole)
    return;
  std::ostringstream message;
  message << cells.columnDesc().name() << " is (";
  for (std::size_t i = 0; i < values.size(); ++i) message << (i == 0 ? "" : ", ") << values[i];
  message << ") " << unit << ", expected finite numbers, a longitude within two turns and a latitude from -90 to 90 degrees";
  throw casacore::AipsError(message.str());
}

/// A direction offset along the circle of declination and along the meridian; with `true_angle` the offset in right ascension
/// is a true angle, too.
MDirection beside(const MDirection& direction, const MDirection& offset, bool true_angle) {
  casacore::MVDirection moved = direction.getValue();
  const casacore::Vector<double> angles = offset.getAngle().getValue();
  if (angles(0) != 0 || angles(1) != 0) moved.shift(angles(0), angles(1), true_angle);
  return {moved, direction.getRef()};
}

}  // namespace

FieldDirections::FieldDirections(const casacore::MeasurementSet& set, const std::string& path, std::shared_ptr<const Body> body)
    : set_(set), path_(path), body_(std::move(body)), plain_(without_ephemerides(set.field())), columns_(plain_) {
  constexpr const char* ephemeris = "EPHEMERIS_ID";
  if (set.field().tableDesc().isColumn(ephemeris))
    ephemeris_id_ = casacore::ScalarColumn<int>(set.field(), ephemeris).getColumn().tovector();
  time_reference_ = casacore::ScalarMeasColumn<casacore::MEpoch>(set, "TIME").getMeasRef();
}

casacore::rownr_t FieldDirections::row_of(int field) const {
  if (field >= 0 && static_cast<casacore::rownr_t>(field) < columns_.nrow()) return static_cast<casacore::rownr_t>(field);
  throw std::runtime_error(path_ + " has rows with FIELD_ID " + std::to_string(field) + ", but FIELD has " +
                           std::to_string(columns_.nrow()) + " rows");
}

std::string FieldDirections::name(int field) const {
  return columns_.name()(row_of(field));
}

std::string FieldDirections::label(int field) const {
  return std::to_string(field) + " (" + name(field) + ")";
}

/// Requires that a field has the directions that NUM_POLY states: casacore would look for them in any case.
void FieldDirections::require_directions(const casacore::ArrayColumn<double>& cells, casacore::rownr_t row) const {
  const int powers = std::max(columns_.numPoly()(row), 0);
  const casacore::IPosition shape = cells.shape(row);
  const ssize_t directions = shape.empty() || shape[0] != 2 ? 0 : shape.product() / 2;
  if (directions <= powers)
    throw casacore::AipsError(std::string(cells.columnDesc().name()) + " has " + std::to_string(directions) +
                              " directions, expected more than NUM_POLY, " + std::to_string(powers));
  std::vector<double> values = cells(row).tovector();
  values.resize(2 * static_cast<std::size_t>(powers + 1));
  require_direction(cells, values);
}

bool FieldDirections::has_ephemeris(casacore::rownr_t row) const {
  return row < ephemeris_id_.size() && ephemeris_id_[row] >= 0 && columns_.numPoly()(row) <= 0;  // which goes before
}

/// True if a field has rates, one of which is not 0.
bool FieldDirections::has_rates(const casacore::ArrayColumn<double>& cells, casacore::rownr_t row) const {
  const int powers = std::max(columns_.numPoly()(row), 0);
  const std::vector<double> values = cells(row).tovector();
  return std::any_of(values.begin() + 2, values.begin() + 2 * (powers + 1), [](double rate) { return rate != 0; });
}

Motion FieldDirections::motion(casacore::rownr_t row, const casacore::ArrayColumn<double>& cells,
                               const casacore::ArrayMeasColumn<MDirection>& column) const {
  require_directions(cells, row);
  if (has_ephemeris(row)) return Motion::target;
  const Motion of_frame = motion_of(frame_of_cell(column, row));
  return of_frame == Motion::none && has_rates(cells, row) ? Motion::target : of_frame;
}

Motion FieldDirections::motion(int field) const {
  const casacore::rownr_t row = row_of(field);
  return translated("cannot find the phase centre of field " + std::to_string(field) + " of " + path_,
                    [&] { return motion(row, columns_.phaseDir(), columns_.phaseDirMeasCol()); });
}

Motion FieldDirections::pointing_motion(int field) const {
  const casacore::rownr_t row = row_of(field);
  return translated("cannot find where antennas point in field " + std::to_string(field) + " of " + path_,
                    [&] { return motion(row, columns_.referenceDir(), columns_.referenceDirMeasCol()); });
}

double FieldDirections::time_s(const casacore::MEpoch& epoch) const {
  return casacore::MEpoch::Convert(epoch, casacore::MEpoch::castType(time_reference_.getType()))().get("s").getValue();
}

/// A TIME relative to FIELD's own TIME, the origin of its polynomials.
double FieldDirections::field_time_s(double time_s) const {
  const auto clock = casacore::MEpoch::castType(columns_.timeMeas().getMeasRef().getType());
  if (clock == casacore::MEpoch::castType(time_reference_.getType())) return time_s;
  return casacore::MEpoch::Convert(epoch(time_s), clock)().get("s").getValue();
}

double FieldDirections::since_origin_s(int field, double time_s) const {
  return goes_by_rates(field) ? field_time_s(time_s) - columns_.time()(row_of(field)) : 0;
}

/// The ephemeris of a field; null where it has none.
const Ephemeris* FieldDirections::ephemeris_of(casacore::rownr_t row) {
  if (!has_ephemeris(row)) return nullptr;
  const int id = ephemeris_id_[row];
  auto known = ephemerides_.find(id);
  if (known == ephemerides_.end()) known = ephemerides_.emplace(id, Ephemeris(ephemeris_path(set_.field(), id))).first;
  return &known->second;
}

MDirection FieldDirections::on_ephemeris(const Ephemeris& ephemeris, const MDirection& offset, const Moment& when) const {
  return beside(ephemeris.at(utc_mjd(epoch(when.time_s))), offset, true);  // as casacore has it
}

MDirection FieldDirections::equatorial(const MDirection& direction, const Moment& when) {
  const auto frame = MDirection::castType(direction.getRef().getType());
  if (frame == MDirection::J2000 || frame == MDirection::ICRS || frame == MDirection::B1950) return direction;
  if (frame == MDirection::COMET)
    throw casacore::AipsError("it is phased to COMET, without an ephemeris; expected an EPHEMERIS_ID, or another frame");
  if (const std::string still = still_frame_name(frame); !still.empty()) {
    imager::SkyDirection here = sky_direction(direction);
    here.frame = still;
    return measure_of(in_frame(here, "FK5"));  // where headers of images have it, too
  }
  const std::string name = MDirection::showType(frame);
  Place& place = place_of(when);
  if (motion_of(frame) == Motion::earth && !place.doubt.empty())
    throw casacore::AipsError("its frame " + name + " turns with the Earth, and " + place.doubt);
  if (is_body_name(name))
    return beside(make_body(name)->seen_from(place.frame, epoch(when.time_s)), direction, false);  // as casacore has it
  return MDirection::Convert(direction, MDirection::Ref(MDirection::J2000, place.frame))();
}

FieldDirections::Place& FieldDirections::place_of(const Moment& when) {
  auto known = places_.find(when.row);
  if (known == places_.end()) {
    const ObservingPlace from = observing_place(set_, observation_of(set_, when.row));
    known = places_.emplace(when.row, Place{{epoch(when.time_s), from.position}, from.doubt}).first;
  }
  known->second.frame.resetEpoch(epoch(when.time_s));
  return known->second;
}

FieldCentre FieldDirections::seen(int field, const MDirection& direction, const Moment& when) {
  const imager::SkyDirection sky = sky_direction(equatorial(direction, when));
  if (!std::isfinite(sky.ra_rad) || !std::isfinite(sky.dec_rad))
    throw casacore::AipsError("it is in no direction at TIME " + std::to_string(when.time_s) + " s");
  return {field, name(field), sky, epoch(when.time_s)};
}

FieldCentre FieldDirections::centre(int field, const Moment& when) {
  const casacore::rownr_t row = row_of(field);
  return translated("cannot find the phase centre of field " + std::to_string(field) + " of " + path_, [&] {
    require_directions(columns_.phaseDir(), row);
    if (const Ephemeris* const ephemeris = ephemeris_of(row))
      return seen(field, on_ephemeris(*ephemeris, *columns_.phaseDirMeasCol()(row).begin(), when), when);
    return seen(field, columns_.phaseDirMeas(row, field_time_s(when.time_s)), when);
  });
}

FieldCentre FieldDirections::target(int field, const Moment& when) {
  const casacore::rownr_t row = row_of(field);
  if (body_)
    return translated("cannot find what the image of field " + std::to_string(field) + " of " + path_ + " moves with",
                      [&] { return seen(field, body_->seen_from(place_of(when).frame, epoch(when.time_s)), when); });
  return translated("cannot find the ephemeris of field " + std::to_string(field) + " of " + path_, [&] {
    const Ephemeris* const ephemeris = ephemeris_of(row);
    const MDirection no_offset(casacore::MVDirection(0.0, 0.0), MDirection::J2000);
    return ephemeris == nullptr ? centre(field, when) : seen(field, on_ephemeris(*ephemeris, no_offset, when), when);
  });
}

const Ephemeris& FieldDirections::ephemeris_with_velocities(int field) {
  if (const Ephemeris* const ephemeris = ephemeris_of(row_of(field))) return *ephemeris;
  throw casacore::AipsError(
      "it has no ephemeris; expected one, or --phasecenter with the name of a planet or the path of an ephemeris");
}

double FieldDirections::recession_m_s(int field, double time_s) {
  return translated("cannot find the velocity of field " + std::to_string(field) + " of " + path_, [&] {
    const casacore::MEpoch when = epoch(time_s);
    return body_ ? body_->recession_m_s(when) : ephemeris_with_velocities(field).recession_m_s(utc_mjd(when));
  });
}

casacore::MFrequency::Types FieldDirections::velocity_frame(int field) {
  return translated("cannot find the velocity of field " + std::to_string(field) + " of " + path_,
                    [&] { return body_ ? body_->velocity_frame() : ms_io::velocity_frame(ephemeris_with_velocities(field)); });
}

bool FieldDirections::is_phased_to_body(int field) const {
  const casacore::rownr_t row = row_of(field);
  return translated("cannot find the phase centre of field " + std::to_string(field) + " of " + path_, [&] {
    return !has_ephemeris(row) && is_body_name(MDirection::showType(frame_of_cell(columns_.phaseDirMeasCol(), row)));
  });
}

imager::SkyDirection FieldDirections::pointing(int field, const Moment& when) {
  const casacore::rownr_t row = row_of(field);
  return translated("cannot find where antennas point in field " + std::to_string(field) + " of " + path_, [&] {
    require_directions(columns_.referenceDir(), row);
    if (const Ephemeris* const ephemeris = ephemeris_of(row))
      return sky_direction(equatorial(on_ephemeris(*ephemeris, *columns_.referenceDirMeasCol()(row).begin(), when), when));
    return sky_direction(equatorial(columns_.referenceDirMeas(row, field_time_s(when.time_s)), when));
  });
}

FieldCentre field_centre(const casacore::MeasurementSet& set, const std::string& path, int field, std::uint64_t row) {
  const double time_s =
      translated("cannot read TIME of " + path, [&] { return casacore::ScalarColumn<double>(set, "TIME")(row); });
  return translated("cannot read FIELD of " + path, [&] { return FieldDirections(set, path); }).centre(field, {time_s, row});
}

}  // namespace misfit::ms_io
