#include <casacore/measures/Measures/MCEpoch.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/Measures/MeasTable.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "imager/numerics/constants.h"
#include "ms_io/field_centres_internal.h"
#include "ms_io/observing_place_internal.h"
#include "ms_io/row_columns_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

constexpr const char* remedies =
    "; select one with --field, or shift all to one direction with --phasecenter, which may also be TRACKFIELD where fields "
    "follow one ephemeris";

/// The way of the selected fields to one phase centre.
class CentreSearch {
 public:
  CentreSearch(const casacore::MeasurementSet& set, const std::string& path, const Selection& selection, SelectedRows& selected)
      : set_(set), path_(path), selection_(selection), selected_(selected), fields_(set, path) {}

  std::optional<imager::SkyDirection> settle() {
    std::set<int> moving;
    for (const auto& [field, row] : selected_.first_row_of_field)
      if (fields_.motion(field) != Motion::none) moving.insert(field);
    if (!moving.empty()) times_ = times_of(set_, path_, selected_, moving);
    for (const auto& [field, times] : times_) follow_motion(field, times);
    if (selection_.phase_centre) return lead_all([&](int, const Moment&) { return *selection_.phase_centre; });
    if (selection_.moving == Selection::Moving::about_targets) return follow_targets();
    return times_.empty() ? shift_from_rounding() : follow_one();
  }

 private:
  using Nowhere = std::optional<imager::SkyDirection>;
  using Centre = FieldCentre (FieldDirections::*)(int, const Moment&);

  std::string label(int field) const { return fields_.label(field) + " of " + path_; }
  std::uint64_t row_of(int field) const { return selected_.first_row_of_field.at(field); }
  Moment moment(int field, double time_s) const { return {time_s, row_of(field)}; }

  /// How far a field moves, at some of its times, and what is to be said of that.
  void follow_motion(int field, const std::vector<double>& times) {
    constexpr std::size_t enough = 64;
    selected_.moving[field] = {times.front(), times.back()};
    const imager::SkyDirection first = fields_.centre(field, moment(field, times.front())).direction;
    const std::size_t step = 1 + (times.size() - 1) / enough;
    for (std::size_t t = times.size() - 1; t > 0; t -= std::min(t, step)) {
      const double moved_rad = separation_rad(first, fields_.centre(field, moment(field, times[t])).direction);
      selected_.moved_rad = std::max(selected_.moved_rad, moved_rad);
    }
    if (fields_.motion(field) == Motion::earth) doubt_rotation(field, times.front());
  }

  /// Without tables of the IERS casacore takes UT1 for UTC, from which it differs by up to 0.9 s: 13.5 arcsec at the equator.
  void doubt_rotation(int field, double time_s) {
    const double utc_d = casacore::MEpoch::Convert(fields_.epoch(time_s), casacore::MEpoch::UTC)().get("d").getValue();
    if (casacore::MeasTable::dUT1(utc_d) != 0) return;
    selected_.remarks.push_back("the frame of field " + label(field) +
                                " turns with the Earth, whose rotation casacore has no IERS table of at that time: directions "
                                "on the sky may be wrong by 13 arcsec, the same way in all programs that lack the table");
  }

  /// Shifts the rows of each field from where they are phased to to where `to` says.
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
    std::vector<imager::PhaseShift> shifts;
    for (const double time_s : moving->second) shifts.push_back(at(moment(field, time_s)));
    const bool none = std::all_of(shifts.begin(), shifts.end(), [](const auto& shift) { return shift.none(); });
    return none ? FieldShift() : FieldShift(moving->second, std::move(shifts));
  }

  double time_of(std::uint64_t row) const {
    return translated("cannot read TIME of " + path_, [&] { return casacore::ScalarColumn<double>(set_, "TIME")(row); });
  }

  /// Fields that stand still: nothing where they are phased to one direction, and one to shift to where rounding parts them.
  Nowhere shift_from_rounding() {
    const auto centre_of = [&](int field) { return fields_.centre(field, {time_of(row_of(field)), row_of(field)}); };
    const FieldCentre first = centre_of(first_field(set_, selected_));
    const double close_rad = close_centre_rad(set_, selected_);
    double most_rad = 0;
    for (const auto& [field, row] : selected_.first_row_of_field) {
      const double apart_rad = separation_rad(first.direction, centre_of(field).direction);
      if (apart_rad > close_rad && selection_.moving != Selection::Moving::shifted_to_middle)
        refuse_apart(first.field, field, apart_rad);
      most_rad = std::max(most_rad, apart_rad);
    }
    if (most_rad <= same_centre_rad) return {};
    if (most_rad > close_rad) return first.direction;  // what stands still on the sky is seen by each about its own
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

  /// Fields of which one or more move, and which must be one.
  Nowhere follow_one() {
    const int field = first_field(set_, selected_);
    require_one(&FieldDirections::centre);
    if (selection_.moving == Selection::Moving::shifted_to_middle) {
      selected_.remarks.push_back("field " + label(field) + " moves by " + angle_words(selected_.moved_rad) +
                                  " while it is observed: the model stands still on the sky; --phasecenter TRACKFIELD lets it "
                                  "move along");
      return usual_centre(fields_, set_, selected_, field).direction;
    }
    if (fields_.motion(field) == Motion::earth && selected_.moved_rad > 0.1 * finest_beam_rad(set_, selected_))
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
    require_one(&FieldDirections::target);
    selected_.follows_field = selected_.follows_target = true;
    return lead_all([&](int field, const Moment& when) { return fields_.target(field, when).direction; });
  }

  /// That all fields move together, as far as can be told: where the ephemeris of one does not reach the times of another,
  /// their names tell.
  void require_one(Centre centre) {
    const int first = first_field(set_, selected_);
    for (const auto& [field, row] : selected_.first_row_of_field) {
      if (field == first) continue;
      if (times_.count(field) != times_.count(first))
        throw std::runtime_error("of fields " + fields_.label(first) + " and " + label(field) + " one moves, by " +
                                 angle_words(selected_.moved_rad) + ", and one stands still" + remedies);
      for (const double time_s : {times_.at(field).front(), times_.at(field).back()}) {
        const std::optional<double> apart_rad = apart(centre, first, moment(field, time_s), field);
        if (apart_rad ? *apart_rad <= noticed_motion_rad(set_, selected_) : fields_.name(first) == fields_.name(field))
          continue;
        throw std::runtime_error(
            "fields " + fields_.label(first) + " and " + label(field) + " both move, " +
            (apart_rad ? angle_words(*apart_rad) + " apart" : "and do not say where at each other's times") + remedies);
      }
    }
  }

  /// Nothing where `one` is nowhere at a time of `other`.
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
  std::map<int, std::vector<double>> times_;  ///< of fields that move, ascending
};

}  // namespace

std::optional<imager::SkyDirection> settle_phase_centre(const casacore::MeasurementSet& set, const std::string& path,
                                                        const Selection& selection, SelectedRows& selected) {
  return translated("cannot read FIELD of " + path, [&] { return CentreSearch(set, path, selection, selected).settle(); });
}

double finest_beam_rad(const casacore::MeasurementSet& set, const SelectedRows& selected) {
  double highest_hz = 0;
  for (const Setup& setup : selected.setups)
    for (const double hz : setup.frequency_hz) highest_hz = std::max(highest_hz, hz);
  const double baseline_m = largest_baseline_m(set);
  return baseline_m > 0 ? imager::speed_of_light_m_s / highest_hz / baseline_m : 0;
}

double close_centre_rad(const casacore::MeasurementSet& set, const SelectedRows& selected) {
  constexpr double least_rad = 5e-11;
  return std::max(1e-3 * finest_beam_rad(set, selected), least_rad);
}

double noticed_motion_rad(const casacore::MeasurementSet& set, const SelectedRows& selected) {
  return std::max(1e-3 * finest_beam_rad(set, selected), same_centre_rad);
}

std::map<int, std::vector<double>> times_of(const casacore::MeasurementSet& set, const std::string& path,
                                            const SelectedRows& selected, const std::set<int>& fields) {
  constexpr std::uint64_t piece_rows = 1 << 16;
  std::map<int, std::vector<double>> times;
  translated("cannot read TIME or FIELD_ID of " + path, [&] {
    const casacore::ScalarColumn<int> field_column(set, "FIELD_ID");
    const casacore::ScalarColumn<double> time_column(set, "TIME");
    casacore::Vector<int> field;
    casacore::Vector<double> time_s;
    for (const BlockRows& block : selected.blocks)
      for (const Rows& piece : pieces(block.runs, piece_rows)) {
        read(field_column, piece, field);
        read(time_column, piece, time_s);
        for (std::uint64_t r = 0; r < piece.count(); ++r) {
          if (fields.count(field(r)) == 0) continue;
          if (!std::isfinite(time_s(r)))
            throw std::runtime_error(path + ": row " + std::to_string(piece[r]) + " has TIME " + std::to_string(time_s(r)) +
                                     ", and its field " + std::to_string(field(r)) + " moves; expected a finite number");
          std::vector<double>& of_field = times[field(r)];
          if (of_field.empty() || of_field.back() != time_s(r)) of_field.push_back(time_s(r));
        }
      }
  });
  for (auto& [field, of_field] : times) {
    std::sort(of_field.begin(), of_field.end());
    of_field.erase(std::unique(of_field.begin(), of_field.end()), of_field.end());
  }
  return times;
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
