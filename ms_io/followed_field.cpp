#include <casacore/casa/Quanta/MVTime.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "ms_io/field_centres_internal.h"
#include "ms_io/followed_field_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/observing_place_internal.h"
#include "ms_io/spectral_frame_internal.h"
#include "ms_io/table_access_internal.h"
#include "ms_io/uvw_scan_internal.h"

namespace misfit::ms_io {
namespace {

/// The field that an image of one set moves with.
class FollowedField {
 public:
  explicit FollowedField(const OpenSet& from)
      : from_(from), field_(first_field(from.set, from.selected)), fields_(from.set, from.path, from.selected.body) {}

  casacore::MEpoch first() const { return fields_.epoch(moving_span(from_.selected).first_s); }
  casacore::MEpoch last() const { return fields_.epoch(moving_span(from_.selected).last_s); }
  std::string name() const { return fields_.name(field_); }
  /// True if the field's place is known at a time: by rates only while it is observed.
  bool goes_on(const casacore::MEpoch& when) const {
    const TimeSpan span = moving_span(from_.selected);
    return from_.selected.body || !fields_.goes_by_rates(field_) ||
           (time_s(when) >= span.first_s && time_s(when) <= span.last_s);
  }
  std::string label() const {
    return from_.selected.body ? from_.selected.body_name : "field " + fields_.label(field_) + " of " + from_.path;
  }

  double time_s(const casacore::MEpoch& when) const { return fields_.time_s(when); }
  imager::SkyDirection at(const casacore::MEpoch& when) {
    const Moment moment{time_s(when), from_.selected.first_row};
    return followed_centre(fields_, from_.selected, field_, moment).direction;
  }
  /// The place at a time; nothing where the ephemeris does not reach it.
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

double beam_of(const OpenSet& set) {
  return set.selected.beam_rad ? *set.selected.beam_rad : finest_beam_rad(set.set, set.path, set.selected);
}

void require_one_target(const OpenSets& sets) {
  if (sets.front()->selected.body) return;
  FollowedField first(*sets.front());
  for (std::size_t s = 1; s < sets.size(); ++s) {
    FollowedField other(*sets[s]);
    const double noticed_rad = noticed_motion_rad(beam_of(*sets[s]));
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
                               " both move, and neither says where it is at the other's times; expected fields of one name, or "
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

/// The phase centre of the first set, if the other set is to be shifted there.
std::optional<imager::SkyDirection> centre_but_for_rounding(const OpenSet& first, const OpenSet& other) {
  const bool one_moves = first.selected.follows_field != other.selected.follows_field;
  if (first.selected.follows_field && !one_moves) return {};
  const imager::SkyDirection centre = describe(first.set, first.path, first.selected).phase_centre;
  const double apart_rad = separation_rad(centre, describe(other.set, other.path, other.selected).phase_centre);
  if (apart_rad <= same_centre_rad && !one_moves) return {};
  const double close_rad = close_centre_rad(std::min(beam_of(first), beam_of(other)));
  const double moved_rad = first.selected.follows_field ? first.selected.moved_rad : other.selected.moved_rad;
  if (apart_rad > close_rad || (one_moves && moved_rad > close_rad)) return {};
  return centre;
}

/// A remark on how far an image moves with the field of the set, and what that means; empty where the motion is too small.
std::string motion_remark(const OpenSet& set, const imager::Observation& observation) {
  const SelectedRows& selected = set.selected;
  if (!selected.follows_field || selected.moved_rad <= noticed_motion_rad(beam_of(set))) return "";
  return FollowedField(set).label() + " moves by " + angle_words(selected.moved_rad) +
         " while it is observed, and images and models move along: what stands still on the sky is smeared about it, and "
         "headers "
         "have where it was at " +
         observation.moving_at + "; --phasecenter with a direction on the sky keeps that still";
}

/// Remarks where frequencies are converted from or to the telescopes' frames, and the place of a telescope is not known.
std::vector<std::string> place_remarks(const OpenSet& set) {
  constexpr const char* own = "TOPOCENT";
  const std::string& frame = set.selected.spectral_frame;
  const auto to_own = [&](const Setup& setup) {
    if (frame != source_frame) return frame == own;
    FieldDirections fields(set.set, set.path, set.selected.body);
    return fields.velocity_frame(setup.field) == casacore::MFrequency::TOPO;
  };
  const auto needs_place = [&](const Setup& setup) {
    return setup.spectral_frame != frame && (setup.spectral_frame == own) != to_own(setup);
  };
  if (frame.empty() || std::none_of(set.selected.setups.begin(), set.selected.setups.end(), needs_place)) return {};
  std::set<std::string> remarks;  // each once
  translated("cannot read ANTENNA or OBSERVATION of " + set.path, [&] {
    for (const int observation : observations_of(set.set, set.selected)) {
      const ObservingPlace place = observing_place(set.set, observation);
      if (!place.dispute.empty())
        remarks.insert("frequencies of " + set.path + " are converted to " + frame + ", and " + place.dispute);
      if (!place.doubt.empty())
        remarks.insert("frequencies of " + set.path + " are converted to " + frame +
                       " without the Earth's rotation, up to 0.5 km/s, since " + place.doubt +
                       "; expected a TELESCOPE_NAME that casacore knows, or positions from the Earth's middle");
    }
  });
  return {remarks.begin(), remarks.end()};
}

}  // namespace

std::vector<std::string> shift_from_rounding(OpenSets& sets, Selection& selection,
                                             const std::function<std::shared_ptr<const OpenSet>(const OpenSet&)>& reopened) {
  std::vector<std::string> sentences;
  if (selection.phase_centre) return sentences;
  auto& first = sets.front();
  for (std::size_t s = 1; s < sets.size(); ++s) {
    const auto centre = centre_but_for_rounding(*first, *sets[s]);
    if (!centre) continue;
    selection.phase_centre = centre;
    sets[s] = reopened(*sets[s]);
    if (first->selected.follows_field) first = reopened(*first);
    sentences.push_back("the phase centre of " + sets[s]->path + " differs from that of " + first->path +
                        " as if by rounding: it is shifted there");
  }
  return sentences;
}

void follow_one_target(const OpenSets& sets, imager::Observation& observation) {
  require_one_target(sets);
  centre_in_middle(sets, observation);
}

std::optional<imager::SkyDirection> followed_at(const OpenSet& set, const std::string& utc) {
  casacore::Quantity time;
  if (!set.selected.follows_field || utc.empty() || !casacore::MVTime::read(time, utc)) return {};
  const casacore::MEpoch when(casacore::MVEpoch(time), casacore::MEpoch::UTC);
  FollowedField field(set);
  return field.goes_on(when) ? field.known_at(when) : std::nullopt;
}

std::vector<std::string> remarks_on(const OpenSets& sets, const Selection& selection, const imager::Observation& observation) {
  std::vector<std::string> remarks{selection.phase_centre_remark};
  for (const auto& set : sets) {
    const SelectedRows& selected = set->selected;
    remarks.insert(remarks.end(), selected.remarks.begin(), selected.remarks.end());
    remarks.push_back(motion_remark(*set, observation));
    for (std::string& remark : place_remarks(*set)) remarks.push_back(std::move(remark));
  }
  remarks.erase(std::remove(remarks.begin(), remarks.end(), ""), remarks.end());
  return remarks;
}

}  // namespace misfit::ms_io
