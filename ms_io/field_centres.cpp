#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "imager/numerics/constants.h"
#include "ms_io/field_centres_internal.h"
#include "ms_io/field_doubts_internal.h"
#include "ms_io/observing_place_internal.h"
#include "ms_io/table_access_internal.h"
#include "ms_io/uvw_scan_internal.h"

namespace misfit::ms_io {
namespace {

constexpr const char* remedies =
    "; select one with --field, or shift all to one direction with --phasecenter, which may also be TRACKFIELD where fields "
    "follow one ephemeris";

/// The search for one phase centre of the selected fields.
class CentreSearch {
 public:
  CentreSearch(const casacore::MeasurementSet& set, const std::string& path, const Selection& selection, SelectedRows& selected)
      : set_(set), path_(path), selection_(selection), selected_(selected), fields_(set, path, body_in(selected)) {}

  std::optional<imager::SkyDirection> settle() {
    std::set<int> moving;
    for (const auto& [field, row] : selected_.first_row_of_field)
      if (selected_.body || fields_.motion(field) != Motion::none) moving.insert(field);
    if (!moving.empty()) times_ = times_of(set_, path_, selected_, moving);
    for (const auto& [field, times] : times_) follow_motion(field, times.used);
    if (selection_.phase_centre) return lead_all([&](int, const Moment&) { return *selection_.phase_centre; });
    if (selection_.moving == Selection::Moving::about_targets) return follow_targets();
    if (times_.empty() || some_hardly_move()) return shift_from_rounding();
    return selection_.moving == Selection::Moving::shifted_to_middle ? stand_still() : follow_one();
  }

 private:
  using Nowhere = std::optional<imager::SkyDirection>;
  using Centre = FieldCentre (FieldDirections::*)(int, const Moment&);

  static std::shared_ptr<const Body> body_in(SelectedRows& selected) {
    if (!selected.body_name.empty()) selected.body = make_body(selected.body_name);
    return selected.body;
  }

  std::string label(int field) const { return fields_.full_label(field); }
  std::uint64_t row_of(int field) const { return selected_.first_row_of_field.at(field); }
  Moment moment(int field, double time_s) const { return {time_s, row_of(field)}; }

  double beam_rad() {
    if (!selected_.beam_rad) selected_.beam_rad = finest_beam_rad(set_, path_, selected_);
    return *selected_.beam_rad;
  }

  /// The centre of an image of the field's rows, unless all rows are shifted to one direction.
  imager::SkyDirection moving_centre(int field, double time_s) {
    const FieldCentre there =
        selected_.body ? fields_.target(field, moment(field, time_s)) : fields_.centre(field, moment(field, time_s));
    return there.direction;
  }

  /// Finds how far a field, or what it follows, moves over some of its times, and adds remarks on that.
  void follow_motion(int field, const std::vector<double>& times) {
    constexpr std::size_t enough = 64;
    selected_.moving[field] = {times.front(), times.back()};
    const imager::SkyDirection first = moving_centre(field, times.front());
    const std::size_t step = 1 + (times.size() - 1) / enough;
    for (std::size_t t = times.size() - 1; t > 0; t -= std::min(t, step)) {
      const double moved_rad = separation_rad(first, moving_centre(field, times[t]));
      if (moved_rad > selected_.moved_rad) farthest_ = field;
      selected_.moved_rad = std::max(selected_.moved_rad, moved_rad);
    }
    const bool earth = fields_.motion(field) == Motion::earth, body = selected_.body || fields_.is_phased_to_body(field);
    if (earth || body)
      require_one_telescope(field, earth ? "the frame of field " + label(field) + " turns with the Earth"
                                         : "field " + label(field) + " is to see " + body_words());
    if (body) say_place_doubt(moment(field, times.front()));
    if (fields_.motion(field) == Motion::none) return;
    for (std::string& doubt : doubts_of_motion(set_, fields_, field, moment(field, times.front())))
      selected_.remarks.push_back(std::move(doubt));
  }

  void say_place_doubt(const Moment& first) {
    const std::string doubt = fields_.place_doubt(first);
    const std::string remark =
        body_words() + " is seen from the middle of the Earth, without the parallax of the telescope, since " + doubt;
    std::vector<std::string>& said = selected_.remarks;
    if (!doubt.empty() && std::find(said.begin(), said.end(), remark) == said.end()) said.push_back(remark);
  }

  std::string body_words() const { return selected_.body ? selected_.body_name : "the body that it is phased to"; }

  void require_one_telescope(int field, const std::string& why) const {
    if (!in_one_place(set_, observations_of(set_, selected_, field)))
      throw std::runtime_error(why +
                               ", and its rows are of telescopes in several places; expected those of one, by --observation");
  }

  /// Shifts the rows of each field from their phase centre to the direction of `to`.
  template <typename To>
  Nowhere lead_all(const To& to) {
    std::map<int, FieldShift> shifts;
    for (Setup& setup : selected_.setups) {
      auto known = shifts.find(setup.field);
      if (known == shifts.end()) known = shifts.emplace(setup.field, shift_of(setup.field, to)).first;
      setup.shift = known->second;
    }
    return {};
  }

  template <typename To>
  FieldShift shift_of(int field, const To& to) {
    const auto at = [&](const Moment& when) { return phase_shift(fields_.centre(field, when), to(field, when)); };
    const auto moving = times_.find(field);
    if (moving == times_.end()) return FieldShift(at({time_of(row_of(field)), row_of(field)}));
    FieldShift::List shifts;
    for (const double time_s : moving->second.used) shifts.push_back({time_s, at(moment(field, time_s))});
    add_idle(field, moving->second.idle, at, shifts);
    const bool none = std::all_of(shifts.begin(), shifts.end(), [](const auto& one) { return one.shift.none(); });
    return none ? FieldShift() : FieldShift(std::move(shifts));
  }

  /// Adds shifts for flagged rows. Rows at whose times the field's place is not known stay where they are.
  template <typename At>
  void add_idle(int field, const std::vector<double>& times, const At& at, FieldShift::List& shifts) {
    std::size_t nowhere = 0;
    for (const double time_s : times) {
      shifts.push_back({time_s, {}});
      try {
        if (!std::isfinite(time_s)) throw std::runtime_error("no time");
        shifts.back().shift = at(moment(field, time_s));
      } catch (const std::runtime_error&) {
        ++nowhere;
      }
    }
    if (nowhere > 0)
      selected_.remarks.push_back("flagged rows of field " + label(field) + " have " + std::to_string(nowhere) +
                                  " TIMEs at which the field's direction is not known: these rows are not shifted");
  }

  double time_of(std::uint64_t row) const {
    return translated("cannot read TIME of " + path_, [&] { return casacore::ScalarColumn<double>(set_, "TIME")(row); });
  }

  /// True if some fields stand still, and all others hardly move.
  bool some_hardly_move() {
    return times_.size() < selected_.first_row_of_field.size() && selected_.moved_rad <= noticed_motion_rad(beam_rad());
  }

  /// For fields that stand still, or hardly move: nothing where they are phased to one direction, or a direction to shift to
  /// where they differ by rounding.
  Nowhere shift_from_rounding() {
    const FieldCentre first = usual_centre(fields_, set_, selected_, first_field(set_, selected_));
    double most_rad = selected_.moved_rad;
    for (const auto& [field, row] : selected_.first_row_of_field) {
      const double apart_rad = separation_rad(first.direction, usual_centre(fields_, set_, selected_, field).direction);
      most_rad = std::max(most_rad, apart_rad);
      if (apart_rad <= same_centre_rad || selection_.moving == Selection::Moving::shifted_to_middle) continue;
      if (apart_rad > close_centre_rad(beam_rad())) refuse_apart(first.field, field, apart_rad);
    }
    if (most_rad <= same_centre_rad) return {};
    if (most_rad > close_centre_rad(beam_rad())) return first.direction;  // each sees what stands still about its own
    selected_.remarks.push_back("fields of " + path_ + " have phase centres up to " + angle_words(most_rad) +
                                " apart, as if by rounding, or far below a pixel: all are shifted to that of field " +
                                fields_.label(first.field));
    return first.direction;
  }

  [[noreturn]] void refuse_apart(int one, int other, double apart_rad) const {
    throw std::runtime_error(path_ + ": fields " + fields_.label(std::min(one, other)) + " and " +
                             fields_.label(std::max(one, other)) + " have phase centres " + angle_words(apart_rad) +
                             " apart; select one with --field, or shift all to one with --phasecenter");
  }

  /// For fields of which one or more move: a direction of the sky to shift all to.
  Nowhere stand_still() {
    if (selected_.moved_rad > noticed_motion_rad(beam_rad()))
      selected_.remarks.push_back("field " + label(farthest_) + " moves by " + angle_words(selected_.moved_rad) +
                                  " while it is observed: the model stands still on the sky; --phasecenter TRACKFIELD lets it "
                                  "move along");
    return usual_centre(fields_, set_, selected_, first_field(set_, selected_)).direction;
  }

  /// For fields of which one or more move: the image moves with them, and all must move as one.
  Nowhere follow_one() {
    const int field = first_field(set_, selected_);
    require_one(&FieldDirections::centre);
    if (fields_.motion(field) == Motion::earth && selected_.moved_rad > 0.1 * beam_rad())
      throw std::runtime_error("field " + label(field) + " is phased to a direction that turns with the Earth, and moves by " +
                               angle_words(selected_.moved_rad) +
                               " over the sky, which is smeared about it; expected --phasecenter with a direction on the sky, "
                               "or TRACKFIELD for what stands still above the telescope");
    selected_.follows_field = true;
    return {};
  }

  Nowhere follow_targets() {
    if (times_.empty())
      throw std::runtime_error("--phasecenter TRACKFIELD: no selected field of " + path_ +
                               " moves; expected one with an ephemeris or NUM_POLY above 0, or no --phasecenter");
    if (!selected_.body) require_one(&FieldDirections::target);
    selected_.follows_field = selected_.follows_target = true;
    return lead_all([&](int field, const Moment& when) { return fields_.target(field, when).direction; });
  }

  /// Requires that all fields move together, as far as can be told: where the ephemeris of one does not reach the times of
  /// another, by their names.
  void require_one(Centre centre) {
    const int first = first_field(set_, selected_);
    for (const auto& [field, row] : selected_.first_row_of_field) {
      if (field == first) continue;
      if (times_.count(field) != times_.count(first))
        throw std::runtime_error("fields " + fields_.label(first) + " and " + label(field) + " differ: one moves, by " +
                                 angle_words(selected_.moved_rad) + ", and one stands still" + remedies);
      for (const double time_s : {times_.at(field).used.front(), times_.at(field).used.back()}) {
        const std::optional<double> apart_rad = apart(centre, first, moment(field, time_s), field);
        if (apart_rad ? *apart_rad <= noticed_motion_rad(beam_rad()) : fields_.name(first) == fields_.name(field)) continue;
        throw std::runtime_error(
            "fields " + fields_.label(first) + " and " + label(field) + " both move, " +
            (apart_rad ? angle_words(*apart_rad) + " apart" : "and neither says where it is at the other's times") + remedies);
      }
    }
  }

  /// The distance of two fields; nothing where the place of `one` is not known at a time of `other`.
  std::optional<double> apart(Centre centre, int one, const Moment& when, int other) {
    const imager::SkyDirection there = (fields_.*centre)(other, when).direction;
    try {
      return separation_rad((fields_.*centre)(one, when).direction, there);
    } catch (const std::runtime_error&) {
      return {};
    }
  }

  const casacore::MeasurementSet& set_;
  const std::string& path_;
  const Selection& selection_;
  SelectedRows& selected_;
  FieldDirections fields_;
  std::map<int, FieldTimes> times_;  ///< of fields that move
  int farthest_ = 0;                 ///< the field that moves farthest
};

}  // namespace

std::optional<imager::SkyDirection> settle_phase_centre(const casacore::MeasurementSet& set, const std::string& path,
                                                        const Selection& selection, SelectedRows& selected) {
  return translated("cannot read FIELD of " + path, [&] { return CentreSearch(set, path, selection, selected).settle(); });
}

double close_centre_rad(double finest_beam_rad) {
  constexpr double least_rad = 5e-11;
  return std::max(1e-3 * finest_beam_rad, least_rad);
}

double noticed_motion_rad(double finest_beam_rad) {
  return std::max(1e-3 * finest_beam_rad, same_centre_rad);
}

FieldCentre followed_centre(FieldDirections& fields, const SelectedRows& selected, int field, const Moment& when) {
  return selected.follows_target ? fields.target(field, when) : fields.centre(field, when);
}

FieldCentre usual_centre(FieldDirections& fields, const casacore::MeasurementSet& set, const SelectedRows& selected,
                         int field) {
  const std::uint64_t row = selected.first_row_of_field.at(field);
  const auto moving = selected.moving.find(field);
  const double time_s =
      moving != selected.moving.end() ? moving->second.middle_s() : casacore::ScalarColumn<double>(set, "TIME")(row);
  return fields.centre(field, {time_s, row});
}

int first_field(const casacore::MeasurementSet& set, const SelectedRows& selected) {
  return casacore::ScalarColumn<int>(set, "FIELD_ID")(selected.first_row);
}

TimeSpan moving_span(const SelectedRows& selected) {
  TimeSpan span = selected.moving.begin()->second;
  for (const auto& [field, other] : selected.moving)
    span = {std::min(span.first_s, other.first_s), std::max(span.last_s, other.last_s)};
  return span;
}

std::string angle_words(double angle_rad) {
  constexpr double degree = imager::pi / 180;
  const auto [unit, name] = angle_rad >= degree          ? std::pair{degree, " degrees"}
                            : angle_rad >= degree / 60   ? std::pair{degree / 60, " arcmin"}
                            : angle_rad >= degree / 3600 ? std::pair{degree / 3600, " arcsec"}
                                                         : std::pair{degree / 3600e3, " mas"};
  std::ostringstream words;
  words.precision(3);
  words << angle_rad / unit << name;
  return words.str();
}

}  // namespace misfit::ms_io
