#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MCEpoch.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/TableMeasures/ArrayMeasColumn.h>
#include <casacore/measures/TableMeasures/ScalarMeasColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <array>

#include "ms_io/celestial_frame_internal.h"
#include "ms_io/field_directions_internal.h"
#include "ms_io/observing_place_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

using casacore::MDirection;

bool is_planet(MDirection::Types frame) {
  return frame >= MDirection::MERCURY && frame < MDirection::N_Planets;
}

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

/// Throws what says so where the place of a planet, in whose frame a direction is, cannot be had.
MDirection from_planet(const MDirection& direction, const MDirection::Ref& to) {
  try {
    return MDirection::Convert(direction, to)();
  } catch (const casacore::AipsError&) {
    throw casacore::AipsError("it is phased to " + MDirection::showType(direction.getRef().getType()) +
                              ", whose place casacore takes from the tables DE200 or DE405, which are not in the folder of "
                              "its data, or do not reach that time; expected these tables there, or a field with an "
                              "ephemeris or a direction of its own");
  }
}

}  // namespace

FieldDirections::FieldDirections(const casacore::MeasurementSet& set, const std::string& path)
    : set_(set), path_(path), columns_(set.field()) {
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

/// That a field has the directions that NUM_POLY tells of: casacore would look for them without.
void FieldDirections::require_directions(const casacore::ArrayColumn<double>& cells, casacore::rownr_t row) const {
  const int powers = columns_.numPoly()(row);
  const casacore::IPosition shape = cells.shape(row);
  const ssize_t directions = shape.empty() || shape[0] == 0 ? 0 : shape.product() / shape[0];
  if (directions > std::max(powers, 0)) return;
  throw casacore::AipsError(std::string(cells.columnDesc().name()) + " has " + std::to_string(directions) +
                            " directions, expected more than NUM_POLY, " + std::to_string(powers));
}

Motion FieldDirections::motion(casacore::rownr_t row, const casacore::ArrayMeasColumn<MDirection>& column) const {
  if (columns_.needInterTime(row)) return Motion::target;
  const casacore::Array<MDirection> directions = column(row);
  return motion_of(MDirection::castType(directions.begin()->getRef().getType()));
}

Motion FieldDirections::motion(int field) const {
  const casacore::rownr_t row = row_of(field);
  return translated("cannot find the phase centre of field " + std::to_string(field) + " of " + path_, [&] {
    require_directions(columns_.phaseDir(), row);
    return motion(row, columns_.phaseDirMeasCol());
  });
}

Motion FieldDirections::pointing_motion(int field) const {
  const casacore::rownr_t row = row_of(field);
  return translated("cannot find where antennas point in field " + std::to_string(field) + " of " + path_, [&] {
    require_directions(columns_.referenceDir(), row);
    return motion(row, columns_.referenceDirMeasCol());
  });
}

double FieldDirections::time_s(const casacore::MEpoch& epoch) const {
  return casacore::MEpoch::Convert(epoch, casacore::MEpoch::castType(time_reference_.getType()))().get("s").getValue();
}

/// TIME as FIELD's own TIME counts it, which polynomials are of.
double FieldDirections::field_time_s(double time_s) const {
  const auto clock = casacore::MEpoch::castType(columns_.timeMeas().getMeasRef().getType());
  if (clock == casacore::MEpoch::castType(time_reference_.getType())) return time_s;
  return casacore::MEpoch::Convert(epoch(time_s), clock)().get("s").getValue();
}

/// Null where the field has none.
const Ephemeris* FieldDirections::ephemeris_of(casacore::rownr_t row) {
  if (columns_.numPoly()(row) > 0) return nullptr;  // which goes before
  const casacore::String path = columns_.ephemPath(row);
  if (path.empty()) return nullptr;
  auto known = ephemerides_.find(path);
  if (known == ephemerides_.end()) known = ephemerides_.emplace(path, Ephemeris(path)).first;
  return &known->second;
}

MDirection FieldDirections::on_ephemeris(const Ephemeris& ephemeris, const MDirection& offset, const Moment& when) const {
  const casacore::MEpoch utc = casacore::MEpoch::Convert(epoch(when.time_s), casacore::MEpoch::UTC)();
  const MDirection followed = ephemeris.at(utc.get("d").getValue());
  casacore::MVDirection direction = followed.getValue();
  const casacore::Vector<double> angles = offset.getAngle().getValue();
  if (angles(0) != 0 || angles(1) != 0) direction.shift(angles(0), angles(1), true);  // true angles, as casacore has it
  return {direction, followed.getRef()};
}

MDirection FieldDirections::equatorial(const MDirection& direction, const Moment& when) {
  const auto frame = MDirection::castType(direction.getRef().getType());
  if (frame == MDirection::J2000 || frame == MDirection::ICRS || frame == MDirection::B1950) return direction;
  if (const std::string still = still_frame_name(frame); !still.empty()) {
    imager::SkyDirection here = sky_direction(direction);
    here.frame = still;
    return measure_of(in_frame(here, "FK5"));  // where headers of images have it, too
  }
  auto known = places_.find(when.row);
  if (known == places_.end()) {
    const ObservingPlace from = observing_place(set_, when.row);
    known = places_.emplace(when.row, Place{{epoch(when.time_s), from.position}, from.doubt}).first;
  }
  const std::string name = MDirection::showType(frame);
  Place& place = known->second;
  if (motion_of(frame) == Motion::earth && !place.doubt.empty())
    throw casacore::AipsError("its frame " + name + " turns with the Earth, and " + place.doubt);
  place.frame.resetEpoch(epoch(when.time_s));
  const MDirection::Ref j2000(MDirection::J2000, place.frame);
  return is_planet(frame) ? from_planet(direction, j2000) : MDirection::Convert(direction, j2000)();
}

FieldCentre FieldDirections::seen(int field, const MDirection& direction, const Moment& when) {
  return {field, name(field), sky_direction(equatorial(direction, when)), epoch(when.time_s)};
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
  return translated("cannot find the ephemeris of field " + std::to_string(field) + " of " + path_, [&] {
    const Ephemeris* const ephemeris = ephemeris_of(row);
    const MDirection no_offset(casacore::MVDirection(0.0, 0.0), MDirection::J2000);
    return ephemeris == nullptr ? centre(field, when) : seen(field, on_ephemeris(*ephemeris, no_offset, when), when);
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
