#include <casacore/tables/Tables/ScalarColumn.h>

#include <cmath>
#include <limits>

#include "ms_io/nearest_field_internal.h"
#include "ms_io/phase_centre_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

double smallest_dish_m(const casacore::MeasurementSet& set, const std::string& path) {
  return translated("cannot read ANTENNA of " + path, [&] {
    double smallest = 0;
    for (const double dish_m : casacore::ScalarColumn<double>(set.antenna(), "DISH_DIAMETER").getColumn())
      if (dish_m > 0 && std::isfinite(dish_m) && (smallest == 0 || dish_m < smallest)) smallest = dish_m;
    return smallest;
  });
}

}  // namespace

NearestField nearest_field(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected,
                           const imager::SkyDirection& centre) {
  NearestField nearest;
  nearest.distance_rad = std::numeric_limits<double>::infinity();
  for (const auto& [field, row] : selected.first_row_of_field) {
    const FieldCentre one = field_centre(set, path, field, row);
    const double distance_rad = separation_rad(one.direction, centre);
    if (distance_rad >= nearest.distance_rad) continue;
    nearest.name = one.name;
    nearest.distance_rad = distance_rad;
  }
  nearest.dish_m = smallest_dish_m(set, path);
  return nearest;
}

}  // namespace misfit::ms_io
