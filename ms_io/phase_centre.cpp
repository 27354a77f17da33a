#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MCEpoch.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/Measures/MeasFrame.h>
#include <casacore/measures/Measures/MeasTable.h>
#include <casacore/measures/TableMeasures/ScalarMeasColumn.h>
#include <casacore/ms/MeasurementSets/MSAntennaColumns.h>
#include <casacore/ms/MeasurementSets/MSFieldColumns.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <cmath>

#include "ms_io/celestial_frame_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/phase_centre_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

using Vector = imager::UvwAxes::Vector;

/// A unit vector in one frame as another has it, at a time.
Vector converted(const Vector& direction, const std::string& from, const std::string& to, const casacore::MeasFrame& when) {
  if (from == to) return direction;
  const casacore::MDirection there(casacore::MVDirection(direction[0], direction[1], direction[2]), direction_type(from));
  const casacore::MDirection::Ref reference(direction_type(to), when);
  const casacore::MVDirection here = casacore::MDirection::Convert(there, reference)().getValue();
  return {here(0), here(1), here(2)};
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector unit(const Vector& a) {
  const double length = std::hypot(a[0], a[1], a[2]);
  return {a[0] / length, a[1] / length, a[2] / length};
}

/// In J2000 where the direction is neither in that nor in ICRS or B1950.
casacore::MDirection equatorial(const casacore::MDirection& direction, const casacore::MeasurementSet& set, std::uint64_t row) {
  const auto frame = casacore::MDirection::castType(direction.getRef().getType());
  if (frame == casacore::MDirection::J2000 || frame == casacore::MDirection::ICRS || frame == casacore::MDirection::B1950)
    return direction;
  return casacore::MDirection::Convert(direction, casacore::MDirection::Ref(casacore::MDirection::J2000, frame_of(set, row)))();
}

void require_field(const casacore::MeasurementSet& set, const std::string& path, int field) {
  if (field >= 0 && static_cast<casacore::rownr_t>(field) < set.field().nrow()) return;
  throw std::runtime_error(path + " has rows with FIELD_ID " + std::to_string(field) + ", but FIELD has " +
                           std::to_string(set.field().nrow()) + " rows");
}

/// That a field has the directions that NUM_POLY tells of: casacore would look for them without.
void require_directions(const casacore::MSFieldColumns& columns, const casacore::ArrayColumn<double>& cells,
                        casacore::rownr_t row) {
  const int powers = columns.numPoly()(row);
  const casacore::IPosition shape = cells.shape(row);
  const ssize_t directions = shape.empty() || shape[0] == 0 ? 0 : shape.product() / shape[0];
  if (directions > std::max(powers, 0)) return;
  throw casacore::AipsError(std::string(cells.columnDesc().name()) + " has " + std::to_string(directions) +
                            " directions, expected more than NUM_POLY, " + std::to_string(powers));
}

}  // namespace

casacore::MeasFrame frame_of(const casacore::MeasurementSet& set, std::uint64_t row) {
  casacore::MeasFrame frame(casacore::ScalarMeasColumn<casacore::MEpoch>(set, "TIME")(row));
  casacore::MPosition position;
  if (!casacore::MeasTable::Observatory(position, telescope_name(set, row)) && set.antenna().nrow() > 0) {
    position = casacore::MSAntennaColumns(set.antenna()).positionMeas()(0);
  }
  frame.set(position);
  return frame;
}

FieldCentre field_centre(const casacore::MeasurementSet& set, const std::string& path, int field, std::uint64_t row) {
  require_field(set, path, field);
  return translated("cannot find the phase centre of field " + std::to_string(field) + " of " + path, [&] {
    const casacore::MSFieldColumns columns(set.field());
    const auto index = static_cast<casacore::rownr_t>(field);
    require_directions(columns, columns.phaseDir(), index);
    const double time = casacore::ScalarColumn<double>(set, "TIME")(row);
    return FieldCentre{field, columns.name()(index), sky_direction(equatorial(columns.phaseDirMeas(index, time), set, row)),
                       casacore::ScalarMeasColumn<casacore::MEpoch>(set, "TIME")(row)};
  });
}

imager::SkyDirection field_pointing(const casacore::MeasurementSet& set, const std::string& path, int field,
                                    std::uint64_t row) {
  require_field(set, path, field);
  return translated("cannot find where antennas point in field " + std::to_string(field) + " of " + path, [&] {
    const casacore::MSFieldColumns columns(set.field());
    const auto index = static_cast<casacore::rownr_t>(field);
    require_directions(columns, columns.referenceDir(), index);
    const double time = casacore::ScalarColumn<double>(set, "TIME")(row);
    return sky_direction(equatorial(columns.referenceDirMeas(index, time), set, row));
  });
}

double separation_rad(const imager::SkyDirection& a, const imager::SkyDirection& b) {
  const Vector one = imager::uvw_axes(a).w, other = converted(imager::uvw_axes(b).w, b.frame, a.frame, {});
  const double chord = std::hypot(one[0] - other[0], one[1] - other[1], one[2] - other[2]);
  return 2 * std::asin(std::min(1.0, chord / 2));
}

imager::PhaseShift phase_shift(const FieldCentre& from, const imager::SkyDirection& to) {
  imager::UvwAxes axes = imager::uvw_axes(to);
  if (from.direction.frame != to.frame) {
    const casacore::MeasFrame when(from.observed);
    const auto north_by = [&](double tangent) {
      const Vector &v = axes.v, &w = axes.w;
      const Vector direction = unit({w[0] + tangent * v[0], w[1] + tangent * v[1], w[2] + tangent * v[2]});
      return converted(direction, to.frame, from.direction.frame, when);
    };
    const Vector here = north_by(0), there = north_by(1e-3);  // near, for B1950 holds aberration, which bends long ways
    axes.w = here;
    axes.u = unit(cross(there, here));
    axes.v = cross(axes.w, axes.u);
  }
  return {imager::uvw_axes(from.direction), axes};
}

}  // namespace misfit::ms_io
