#include <casacore/tables/Tables/ScalarColumn.h>

#include <cmath>
#include <utility>

#include "ms_io/celestial_frames.h"
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

}  // namespace

ImageView::ImageView(const OpenSet& open_set, const imager::SkyDirection& centre)
    : open_set_(open_set),
      centre_(centre),
      dish_m_(smallest_dish_m(open_set.set, open_set.path)),
      fields_(open_set.set, open_set.path, open_set.selected.body) {}

imager::SkyDirection ImageView::seen(const imager::SkyDirection& direction, double time_s) {
  const SelectedRows& selected = open_set_.selected;
  if (!selected.follows_field) return in_frame(direction, centre_.frame);
  if (!then_ || then_->first != time_s) {
    const int field = first_field(open_set_.set, selected);
    then_ = {time_s, followed_centre(fields_, selected, field, {time_s, selected.first_row}).direction};
  }
  const imager::SkyDirection& then = then_->second;
  return imager::sky_direction(imager::direction_cosines(in_frame(direction, then.frame), then), centre_);
}

FieldPointing ImageView::pointing(int field, const imager::SkyDirection& direction, std::optional<double> time_s) const {
  const std::string when = time_s ? " at " + utc_text(utc_s(fields_.epoch(*time_s))) : "";
  return {fields_.label(field) + when,        direction, field, fields_.name(field), open_set_.path,
          separation_rad(direction, centre_), dish_m_};
}

std::vector<FieldPointing> ImageView::of_field(int field, std::uint64_t row) {
  const bool moves = open_set_.selected.moving.count(field) > 0 || fields_.pointing_motion(field) != Motion::none;
  if (!moves) {
    const double time_s = casacore::ScalarColumn<double>(open_set_.set, "TIME")(row);
    return {pointing(field, in_frame(fields_.pointing(field, {time_s, row}), centre_.frame))};
  }
  const auto of_fields = times_of(open_set_.set, open_set_.path, open_set_.selected, {field});
  if (of_fields.empty()) return {};  // a rank may have none of its rows
  const std::vector<double>& times = of_fields.at(field).used;
  std::vector<FieldPointing> pointings;
  for (const double time_s : {times.front(), times[times.size() / 2], times.back()})
    pointings.push_back(pointing(field, seen(fields_.pointing(field, {time_s, row}), time_s), time_s));
  return pointings;
}

std::vector<FieldPointing> field_pointings(const OpenSet& open_set, const imager::SkyDirection& centre) {
  ImageView view(open_set, centre);
  std::vector<FieldPointing> all;
  translated("cannot read FIELD of " + open_set.path, [&] {
    for (const auto& [field, row] : open_set.selected.first_row_of_field)
      for (FieldPointing& pointing : view.of_field(field, row)) all.push_back(std::move(pointing));
  });
  return all;
}

}  // namespace misfit::ms_io
