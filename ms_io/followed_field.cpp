#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "ms_io/field_centres_internal.h"
#include "ms_io/followed_field_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/observing_place_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

/// The field that an image of one set moves with.
class FollowedField {
 public:
  explicit FollowedField(const OpenSet& from)
      : from_(from), field_(first_field(from.set, from.selected)), fields_(from.set, from.path) {}

  casacore::MEpoch first() const { return fields_.epoch(moving_span(from_.selected).first_s); }
  casacore::MEpoch last() const { return fields_.epoch(moving_span(from_.selected).last_s); }
  std::string name() const { return fields_.name(field_); }
  std::string label() const { return "field " + fields_.label(field_) + " of " + from_.path; }

  double time_s(const casacore::MEpoch& when) const { return fields_.time_s(when); }
  imager::SkyDirection at(const casacore::MEpoch& when) {
    const Moment moment{time_s(when), from_.selected.first_row};
    return followed_centre(fields_, from_.selected, field_, moment).direction;
  }
  /// Nothing where an ephemeris does not tell.
  std::optional<imager::SkyDirection> known_at(const casacore::MEpoch& when) {
    try {
      return at(when);
    } catch (const std::runtime_error&) {
      return {};
    }
  }

 private:
  const OpenSet& from_;
  int field_;
  FieldDirections fields_;
};

void require_one_target(const OpenSets& sets) {
  FollowedField first(*sets.front());
  for (std::size_t s = 1; s < sets.size(); ++s) {
    FollowedField other(*sets[s]);
    const double noticed_rad = noticed_motion_rad(sets[s]->set, sets[s]->selected);
    bool told = false;
    for (const casacore::MEpoch& when : {first.first(), first.last(), other.first(), other.last()}) {
      const auto one = first.known_at(when), two = other.known_at(when);
      if (!one || !two) continue;
      told = true;
      if (const double apart_rad = separation_rad(*one, *two); apart_rad > noticed_rad)
        throw std::runtime_error(first.label() + " and " + other.label() + " both move, " + angle_words(apart_rad) +
                                 " apart; expected one target, or --phasecenter with a direction to shift all to");
    }
    if (!told && first.name() != other.name())
      throw std::runtime_error(first.label() + " and " + other.label() +
                               " both move, and neither says where at the other's times; expected fields of one name, or "
                               "--phasecenter with a direction to shift all to");
  }
}

void centre_in_middle(const OpenSets& sets, imager::Observation& observation) {
  double first_s = std::numeric_limits<double>::infinity(), last_s = -first_s;
  for (const auto& set : sets) {
    const FollowedField field(*set);
    first_s = std::min(first_s, utc_s(field.first()));
    last_s = std::max(last_s, utc_s(field.last()));
  }
  const double middle_s = first_s + (last_s - first_s) / 2;
  double least_s = std::numeric_limits<double>::infinity();
  for (const auto& set : sets) {
    const FollowedField field(*set);
    const double there_s = std::clamp(middle_s, utc_s(field.first()), utc_s(field.last()));
    if (std::abs(there_s - middle_s) >= least_s) continue;
    least_s = std::abs(there_s - middle_s);
    const casacore::MEpoch there(casacore::MVEpoch(casacore::Quantity(there_s, "s")), casacore::MEpoch::UTC);
    centre_on_field(set->set, set->path, set->selected, field.time_s(there), observation);
  }
}

/// How far an image moves with the field of the set, and what that means, where that is noticed.
std::string motion_remark(const OpenSet& set, const imager::Observation& observation) {
  const SelectedRows& selected = set.selected;
  if (!selected.follows_field || selected.moved_rad <= noticed_motion_rad(set.set, selected)) return "";
  return FollowedField(set).label() + " moves by " + angle_words(selected.moved_rad) +
         " while it is observed, and images and models move along: what stands still on the sky is smeared about it, and "
         "headers "
         "have where it was at " +
         observation.moving_at + "; --phasecenter with a direction on the sky keeps that still";
}

/// Where frequencies are converted from or to those of the telescope itself, and it is not known where that stands.
std::string place_remark(const OpenSet& set) {
  constexpr const char* own = "TOPOCENT";
  const std::string& frame = set.selected.spectral_frame;
  const auto needs_place = [&](const Setup& setup) { return (setup.spectral_frame == own) != (frame == own); };
  if (frame.empty() || std::none_of(set.selected.setups.begin(), set.selected.setups.end(), needs_place)) return "";
  const std::string doubt =
      translated("cannot read ANTENNA of " + set.path, [&] { return observing_place(set.set, set.selected.first_row).doubt; });
  if (doubt.empty()) return "";
  return "frequencies of " + set.path + " are converted to " + frame + " without the Earth's rotation, up to 0.5 km/s, since " +
         doubt + "; expected a TELESCOPE_NAME that casacore knows, or positions from the Earth's middle";
}

}  // namespace

std::optional<imager::SkyDirection> centre_but_for_rounding(const OpenSet& first, const OpenSet& other) {
  if (first.selected.follows_field || other.selected.follows_field) return {};
  const imager::SkyDirection centre = describe(first.set, first.path, first.selected).phase_centre;
  const double apart_rad = separation_rad(centre, describe(other.set, other.path, other.selected).phase_centre);
  const double close_rad = std::min(close_centre_rad(first.set, first.selected), close_centre_rad(other.set, other.selected));
  if (apart_rad <= same_centre_rad || apart_rad > close_rad) return {};
  return centre;
}

void follow_one_target(const OpenSets& sets, imager::Observation& observation) {
  require_one_target(sets);
  centre_in_middle(sets, observation);
}

std::vector<std::string> remarks_on(const OpenSets& sets, const Selection& selection, const imager::Observation& observation) {
  std::vector<std::string> remarks{selection.phase_centre_remark};
  for (const auto& set : sets) {
    const SelectedRows& selected = set->selected;
    if (selected.phase_centre && !selection.phase_centre && selected.remarks.empty())
      remarks.push_back("the phase centre of " + set->path + " differs from that of " + sets.front()->path +
                        " as if by rounding: it is shifted there");
    remarks.insert(remarks.end(), selected.remarks.begin(), selected.remarks.end());
    remarks.push_back(motion_remark(*set, observation));
    remarks.push_back(place_remark(*set));
  }
  remarks.erase(std::remove(remarks.begin(), remarks.end(), ""), remarks.end());
  return remarks;
}

}  // namespace misfit::ms_io
