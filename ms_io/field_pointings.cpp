#include <casacore/tables/Tables/ScalarColumn.h>

#include <cmath>

#include "ms_io/celestial_frames.h"
#include "ms_io/field_pointings_internal.h"
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

std::vector<FieldPointing> field_pointings(const OpenSet& open_set, const imager::SkyDirection& centre) {
  const double dish_m = smallest_dish_m(open_set.set, open_set.path);
  std::vector<FieldPointing> pointings;
  for (const auto& [field, row] : open_set.selected.first_row_of_field) {
    const std::string name = field_centre(open_set.set, open_set.path, field, row).name;
    const imager::SkyDirection direction = in_frame(field_pointing(open_set.set, open_set.path, field, row), centre.frame);
    pointings.push_back({std::to_string(field) + " (" + name + ")",
                         direction,
                         name,
                         open_set.path,
                         separation_rad(direction, centre),
                         dish_m,
                         {}});
  }
  return pointings;
}

}  // namespace misfit::ms_io
