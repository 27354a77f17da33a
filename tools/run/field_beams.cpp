#include "tools/run/field_beams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include "imager/beams/primary_beam.h"
#include "imager/beams/telescopes.h"
#include "imager/data/phase_shift.h"
#include "imager/numerics/constants.h"
#include "tools/base/numbers.h"
#include "tools/run/run_messages.h"

namespace misfit::tools {
namespace {

constexpr double rounding_rad = 1e-9;  ///< by which directions that mean the same may differ
constexpr std::size_t most_listed = 20;

/// How a field's antennas see the centre of the image.
struct SeenCentre {
  std::string field;
  double from_centre_rad = 0;
  std::string no_beam = {};  ///< why no beam is known; else empty, and
  double width_rad = 0;      ///< of the beam between its half-power points,
  double beam = 0;           ///< the beam at the centre,
  bool beyond_null = false;  ///< whether no dish's main lobe reaches that far
  std::string doubt = {};    ///< what may be wrong with it; else empty
};

/// The beam of a pointing's rows. Throws imager::NoSimpleBeam.
imager::PrimaryBeam beam_of(const ms_io::FieldPointing& pointing, const std::vector<imager::AntennaSort>& sorts,
                            const ApartOptions& o, std::string& doubt) {
  std::map<std::uint8_t, imager::Pattern> patterns;  // of these rows' antennas alone: others may have none
  const auto dish = [&](std::uint8_t sort) {
    imager::Pattern& pattern = patterns[sort];
    if (pattern) return pattern;
    const imager::BeamModel model = o.beams.of(sorts.at(sort));
    if (const std::string told = model.doubt_at(o.frequency_hz); !told.empty()) doubt = told;
    return pattern = model.pattern;
  };
  std::vector<imager::BeamShare> shares;
  for (const ms_io::SortRows& some : pointing.rows)
    shares.push_back({dish(some.pair.one), dish(some.pair.other), o.frequency_hz, static_cast<double>(some.rows)});
  if (shares.empty()) throw imager::NoSimpleBeam("no row of two antennas is selected");
  return imager::PrimaryBeam(shares);
}

SeenCentre seen_centre(const ms_io::FieldPointing& pointing, const ms_io::BeamRows& rows, const ApartOptions& o,
                       const std::vector<ms_io::FieldPointing>& pointings) {
  SeenCentre seen{field_words(pointing, pointings), pointing.from_centre_rad};
  try {
    const imager::PrimaryBeam beam = beam_of(pointing, rows.sorts, o, seen.doubt);
    const double sine = seen.from_centre_rad < imager::pi / 2 ? std::sin(seen.from_centre_rad) : 1;
    const bool behind = seen.from_centre_rad >= imager::pi / 2;
    seen.width_rad = beam.half_power_width_rad();
    seen.beam = behind ? 0 : beam.power(sine);
    seen.beyond_null = behind || sine > beam.main_lobe_sine();
  } catch (const imager::NoSimpleBeam& error) {
    seen.no_beam = error.what();
  }
  return seen;
}

std::string described(const SeenCentre& seen) {
  const bool at_centre = seen.from_centre_rad < rounding_rad;
  std::string text = seen.field + (at_centre ? ", at it" : ", " + angle_text(seen.from_centre_rad, 3) + " away");
  if (!seen.no_beam.empty()) return text;
  if (!at_centre) text += " (" + significant(seen.from_centre_rad / seen.width_rad, 3) + " beam widths)";
  return text + ", to " + significant(seen.beam, 3);
}

/// Describes the first `most` of them, which lie farthest away; all where `most` is 0.
std::string described(const std::vector<SeenCentre>& farthest_first, std::size_t most) {
  std::string text;
  const std::size_t count = most == 0 ? farthest_first.size() : std::min(most, farthest_first.size());
  for (std::size_t i = 0; i < count; ++i) text += (i == 0 ? "" : "; ") + described(farthest_first[i]);
  if (count < farthest_first.size()) text += "; and " + std::to_string(farthest_first.size() - count) + " nearer ones";
  return text;
}

/// The reasons why beams are not known, or in doubt, once each.
std::string doubts_of(const std::vector<SeenCentre>& fields) {
  std::vector<std::string> told;
  const auto tell = [&told](const std::string& before, const std::string& reason) {
    if (!reason.empty() && std::find(told.begin(), told.end(), before + reason) == told.end()) told.push_back(before + reason);
  };
  for (const SeenCentre& seen : fields) {
    tell("where no number stands the beam is not known: ", seen.no_beam);
    tell("", seen.doubt);
  }
  std::string text;
  for (const std::string& sentence : told) text += "; " + sentence;
  return text;
}

double largest_apart_rad(const std::vector<ms_io::FieldPointing>& pointings) {
  double largest = 0;
  for (const ms_io::FieldPointing& pointing : pointings)
    largest = std::max(largest, angle_between(pointing.direction, pointings.front().direction));
  return largest;
}

bool nearer(const ms_io::FieldPointing& a, const ms_io::FieldPointing& b) {
  return a.from_centre_rad < b.from_centre_rad;
}

/// A warning that the image's centre lies beyond the first null of the only field, or of several that point alike; empty where
/// it does not, or the beam is not known.
std::string far_warning(const ms_io::FieldPointing& nearest, const ms_io::MeasurementSet& set, const ApartOptions& o) {
  // The smallest dish's null lies beyond its λ/D: nearer than that the antennas of all rows need not be read.
  const double least_rad =
      nearest.smallest_dish_m > 0 ? imager::speed_of_light_m_s / o.frequency_hz / nearest.smallest_dish_m : 0;
  if (least_rad == 0 || nearest.from_centre_rad < least_rad) return "";
  ms_io::BeamRows rows;
  try {
    rows = set.beam_rows();
  } catch (const std::runtime_error&) {  // of FEED and the like, which images do not need
    return "";
  }
  const auto pointing = std::min_element(rows.pointings.begin(), rows.pointings.end(), nearer);
  const SeenCentre seen = seen_centre(*pointing, rows, o, rows.pointings);
  if (!seen.no_beam.empty() || !seen.beyond_null) return "";
  return "the image's centre lies beyond the first null of the beam: field " + described(seen) + " at " +
         frequency_text(o.frequency_hz, 4) + doubts_of({seen}) + "; it may show noise alone";
}

/// The names of fields that do not see the centre.
std::string names_beyond(const std::vector<SeenCentre>& fields) {
  std::string names;
  std::size_t beyond = 0;
  for (const SeenCentre& seen : fields)
    if (seen.beyond_null && ++beyond <= most_listed) names += (names.empty() ? "" : ", ") + seen.field;
  return beyond > most_listed ? names + " and " + std::to_string(beyond - most_listed) + " more" : names;
}

/// The largest angle between directions that count as one.
double noticed_apart_rad(const std::vector<SeenCentre>& seen) {
  constexpr double same_without_beam_rad = 5e-6;  // an arcsecond
  double narrowest_rad = 0;
  for (const SeenCentre& one : seen)
    if (one.width_rad > 0 && (narrowest_rad == 0 || one.width_rad < narrowest_rad)) narrowest_rad = one.width_rad;
  return narrowest_rad > 0 ? same_pointing_beams * narrowest_rad : same_without_beam_rad;
}

/// "feed 1", with its antenna where feeds of this number differ, and its set where there are several.
std::string feed_words(const ms_io::FeedOffset& feed, const std::vector<ms_io::FeedOffset>& feeds) {
  const auto any = [&](const auto& holds) { return std::any_of(feeds.begin(), feeds.end(), holds); };
  const auto alike = [&](const ms_io::FeedOffset& other) { return other.set == feed.set && other.feed == feed.feed; };
  std::string words = "feed " + std::to_string(feed.feed);
  if (feed.antenna >= 0 && std::count_if(feeds.begin(), feeds.end(), alike) > 1)
    words += " of antenna " + std::to_string(feed.antenna);
  if (any([&](const ms_io::FeedOffset& other) { return other.set != feed.set; })) words += " of " + feed.set;
  return words;
}

/// Words for what points apart: "fields".
struct ApartWords {
  std::string what;
  std::string where;   ///< the place that they see: "the image's centre"
  std::string remedy;  ///< the option that takes one alone
};

/// Lists fields or feeds that point apart. Throws std::runtime_error where some see nothing, unless `force`.
FieldNotes notes_on_averaged(std::vector<SeenCentre> seen, const ApartWords& words, const ApartOptions& o) {
  std::stable_sort(seen.begin(), seen.end(),
                   [](const SeenCentre& a, const SeenCentre& b) { return a.from_centre_rad > b.from_centre_rad; });
  const std::string beyond = names_beyond(seen), at = words.where + ", " + frequency_text(o.frequency_hz, 4) + ": ";
  const std::string listed = at + described(seen, most_listed) + doubts_of(seen);
  if (!beyond.empty() && !o.force)
    throw std::runtime_error(words.what + " that point apart would be averaged into one image, but " + beyond +
                             " cannot see its centre, which lies beyond the first null of the beam. Each is dimmed at " +
                             listed + "; expected " + words.what + " that see it: " + words.remedy +
                             ", or average all with --force-average, which dims what each sees");
  return {{{words.what + " averaged", std::to_string(seen.size()) + ", which point apart",
            "each is dimmed at " + at + described(seen, 0) + doubts_of(seen)}},
          {words.what + " that point apart are averaged into one image. Each is dimmed at " + listed +
           (beyond.empty() ? "" : "; --force-average takes those beyond the first null too") + ". No flux is that of one " +
           words.what.substr(0, words.what.size() - 1) + "; " + words.remedy}};
}

/// Notes on feeds. Rows are read only where FEED has a beam beside its dish's axis.
FieldNotes notes_on_feeds_of(const ms_io::MeasurementSet& set, const ApartOptions& o) {
  ms_io::BeamRows rows;
  try {
    if (set.beam_offset_rad() == 0) return {};
    rows = set.beam_rows();
  } catch (const std::runtime_error&) {  // of FEED and the like, which images do not need
    return {};
  }
  return notes_on_feeds(rows, o);
}

}  // namespace

double angle_between(const imager::SkyDirection& one, const imager::SkyDirection& other) {
  const auto a = imager::uvw_axes(one).w, b = imager::uvw_axes(other).w;
  return 2 * std::asin(std::min(1.0, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) / 2));
}

std::string field_words(const ms_io::FieldPointing& pointing, const std::vector<ms_io::FieldPointing>& pointings) {
  const bool several_sets =
      std::any_of(pointings.begin(), pointings.end(), [&](const auto& other) { return other.set != pointings.front().set; });
  return pointing.field + (several_sets ? " of " + pointing.set : "");
}

void require_still(const std::vector<ms_io::FieldPointing>& pointings, double width_rad) {
  for (const ms_io::FieldPointing& one : pointings)
    for (const ms_io::FieldPointing& other : pointings)
      if (one.set == other.set && one.id == other.id &&
          angle_between(one.direction, other.direction) > same_pointing_beams * width_rad)
        throw std::runtime_error("antennas of field " + field_words(one, pointings) + " and " + field_words(other, pointings) +
                                 " pointed " + angle_text(angle_between(one.direction, other.direction), 3) +
                                 " apart: beams that move past the image are not applied; expected some of its time with "
                                 "--timerange");
}

FieldNotes notes_on_apart_fields(const ms_io::BeamRows& rows, const ApartOptions& o) {
  const std::vector<ms_io::FieldPointing>& pointings = rows.pointings;
  std::vector<SeenCentre> fields;
  for (const ms_io::FieldPointing& pointing : pointings) fields.push_back(seen_centre(pointing, rows, o, pointings));
  if (largest_apart_rad(pointings) <= noticed_apart_rad(fields)) return {};
  return notes_on_averaged(
      std::move(fields),
      {"fields", "the image's centre", "choose by --field or --vis, or make a mosaic of all by --gridder mosaic"}, o);
}

FieldNotes notes_on_feeds(const ms_io::BeamRows& rows, const ApartOptions& o) {
  ms_io::FieldPointing all{"", {}};  // with the rows of all fields
  for (const ms_io::FieldPointing& pointing : rows.pointings)
    all.rows.insert(all.rows.end(), pointing.rows.begin(), pointing.rows.end());
  const double to_field_rad = std::min_element(rows.pointings.begin(), rows.pointings.end(), nearer)->from_centre_rad;
  std::vector<SeenCentre> feeds;
  double apart_rad = 0;
  for (const ms_io::FeedOffset& feed : rows.feeds) {
    all.field = feed_words(feed, rows.feeds);
    all.from_centre_rad = std::max(0.0, feed.rad() - to_field_rad);  // at least, whichever way mounts turn it
    const bool beyond_null = seen_centre(all, rows, o, {}).beyond_null;
    all.from_centre_rad = feed.rad();
    feeds.push_back(seen_centre(all, rows, o, {}));
    feeds.back().beyond_null = beyond_null;
    for (const ms_io::FeedOffset& other : rows.feeds)
      apart_rad = std::max(apart_rad, std::hypot(feed.x_rad - other.x_rad, feed.y_rad - other.y_rad));
  }
  if (feeds.empty() || apart_rad <= noticed_apart_rad(feeds)) return {};
  return notes_on_averaged(
      std::move(feeds),
      {"feeds", "the field's direction", "split the rows of one feed, by FEED1 and FEED2, into a set of their own"}, o);
}

FieldNotes notes_on_fields(const ImageOptions& options, const ms_io::MeasurementSet& set,
                           const imager::ImageGeometry& geometry) {
  FieldNotes notes;
  if (options.makes_mosaic()) return notes;  // which refuses feeds that point beside their axes
  std::vector<ms_io::FieldPointing> pointings;
  try {
    pointings = set.field_pointings();
  } catch (const std::runtime_error& error) {  // which images do not need
    notes.warnings.push_back("whether the antennas see the image is not known: " + std::string(error.what()));
    return notes;
  }
  if (pointings.empty()) return notes;
  const ApartOptions o{set.observation().frequency_hz, options.force_average, DishBeams(options.primary_beam.beam)};
  const bool one = std::all_of(pointings.begin(), pointings.end(), [&](const auto& pointing) {
    return pointing.set == pointings.front().set && pointing.id == pointings.front().id;  // which may move
  });
  if (!one && largest_apart_rad(pointings) > rounding_rad) notes = notes_on_apart_fields(set.beam_rows(), o);
  if (notes.warnings.empty()) {
    const auto nearest = std::min_element(pointings.begin(), pointings.end(), nearer);
    std::string warning = far_warning(*nearest, set, o);
    if (warning.empty()) warning = pointing_warning(*nearest, geometry, o.frequency_hz);
    if (!warning.empty()) notes.warnings.push_back(std::move(warning));
  }
  const FieldNotes feeds = notes_on_feeds_of(set, o);
  notes.decisions.insert(notes.decisions.end(), feeds.decisions.begin(), feeds.decisions.end());
  notes.warnings.insert(notes.warnings.end(), feeds.warnings.begin(), feeds.warnings.end());
  return notes;
}

}  // namespace misfit::tools
