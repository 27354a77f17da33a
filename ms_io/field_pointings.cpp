#include <casacore/tables/Tables/ScalarColumn.h>

#include <cmath>

#include "ms_io/celestial_frames.h"
#include "ms_io/field_centres_internal.h"
#include "ms_io/field_pointings_internal.h"
#include "ms_io/metadata_internal.h"
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

/// Of the fields of a set, as they stand to an image.
class Pointings {
 public:
  Pointings(const OpenSet& open_set, const imager::SkyDirection& centre)
      : open_set_(open_set),
        centre_(centre),
        dish_m_(smallest_dish_m(open_set.set, open_set.path)),
        fields_(open_set.set, open_set.path, open_set.selected.body) {}

  /// One direction or, where the field moves, three in the course of time.
  void add(int field, std::uint64_t row) {
    const bool moves = open_set_.selected.moving.count(field) > 0 || fields_.pointing_motion(field) != Motion::none;
    if (!moves) {
      const double time_s = casacore::ScalarColumn<double>(open_set_.set, "TIME")(row);
      return add(field, in_frame(fields_.pointing(field, {time_s, row}), centre_.frame), "");
    }
    const auto of_fields = times_of(open_set_.set, open_set_.path, open_set_.selected, {field});
    if (of_fields.empty()) return;  // a rank may have none of its rows
    const std::vector<double>& times = of_fields.at(field).used;
    for (const double time_s : {times.front(), times[times.size() / 2], times.back()})
      add(field, seen(fields_.pointing(field, {time_s, row}), time_s), " at " + utc_text(utc_s(fields_.epoch(time_s))));
  }

  std::vector<FieldPointing> take() { return std::move(pointings_); }

 private:
  void add(int field, const imager::SkyDirection& direction, const std::string& when) {
    pointings_.push_back({fields_.label(field) + when, direction, field, fields_.name(field), open_set_.path,
                          separation_rad(direction, centre_), dish_m_});
  }

  /// Where the direction lies in the image at a time, as the image's header has it.
  imager::SkyDirection seen(const imager::SkyDirection& pointing, double time_s) {
    const SelectedRows& selected = open_set_.selected;
    if (!selected.follows_field) return in_frame(pointing, centre_.frame);
    const imager::SkyDirection then =
        followed_centre(fields_, selected, first_field(open_set_.set, selected), {time_s, selected.first_row}).direction;
    return imager::sky_direction(imager::direction_cosines(in_frame(pointing, then.frame), then), centre_);
  }

  const OpenSet& open_set_;
  const imager::SkyDirection& centre_;
  double dish_m_;
  FieldDirections fields_;
  std::vector<FieldPointing> pointings_;
};

}  // namespace

std::vector<FieldPointing> field_pointings(const OpenSet& open_set, const imager::SkyDirection& centre) {
  Pointings pointings(open_set, centre);
  translated("cannot read FIELD of " + open_set.path, [&] {
    for (const auto& [field, row] : open_set.selected.first_row_of_field) pointings.add(field, row);
  });
  return pointings.take();
}

}  // namespace misfit::ms_io
