#include <casacore/casa/Quanta/MVAngle.h>
#include <casacore/casa/Quanta/Quantum.h>
#include <casacore/tables/Tables/ScalarColumn.h>
#include <casacore/tables/Tables/Table.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "ms_io/body_internal.h"
#include "ms_io/capitals.h"
#include "ms_io/field_centres_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/sexagesimal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

/// FITS RADESYS of a frame's name in CASA; empty for others.
std::string frame_named(const std::string& of) {
  const std::string name = capitals(of);
  return name == "J2000" ? "FK5" : name == "ICRS" ? "ICRS" : name == "B1950" ? "FK4" : "";
}

/// The angle, which must have a unit or be sexagesimal.
std::optional<double> angle_rad(const std::string& text) {
  if (is_sexagesimal(text)) return sexagesimal_rad(text, Colons::hours, Parts::some);
  // casacore takes all units of time for angles; only the hour is meant as one.
  const std::string unit = text.substr(std::min(text.find_last_of("0123456789.") + 1, text.size()));
  casacore::Quantity angle;
  if (unit.empty() || unit == "s" || unit == "m" || !casacore::MVAngle::read(angle, text)) return {};
  if (!angle.isConform("rad") && unit != "h") return {};
  return angle.getValue("rad");
}

/// The fields that the text names: the one of that id, as --field takes numbers, or all of that name.
std::vector<int> fields_in(const casacore::MeasurementSet& set, const std::string& text) {
  const auto names = casacore::ScalarColumn<casacore::String>(set.field(), "NAME").getColumn().tovector();
  const bool number = !text.empty() && text.size() < 9 && text.find_first_not_of("0123456789") == std::string::npos;
  if (number && std::stoul(text) < names.size()) return {std::stoi(text)};
  std::vector<int> named;
  for (std::size_t field = 0; field < names.size(); ++field)
    if (names[field] == casacore::String(text)) named.push_back(static_cast<int>(field));
  return named;
}

/// The first row of the field, if it has any.
std::optional<std::uint64_t> first_row_of(const casacore::MeasurementSet& set, int field) {
  const std::vector<int> fields = casacore::ScalarColumn<int>(set, "FIELD_ID").getColumn().tovector();
  const auto found = std::find(fields.begin(), fields.end(), field);
  if (found == fields.end()) return {};
  return static_cast<std::uint64_t>(found - fields.begin());
}

/// The direction that a text means.
struct Meant {
  imager::SkyDirection direction;
  std::string remark = {};  ///< for a field that moves, or could be taken for another; else empty
  std::string label = {};   ///< of the field
};

/// The direction that a field is phased to; where that moves, in the middle of its rows.
Meant centre_in(const casacore::MeasurementSet& set, const std::string& path, int field) {
  SelectedRows all;
  all.first_row = first_row_of(set, field).value_or(0);
  all.first_row_of_field[field] = all.first_row;
  all.blocks = {{0, {{0, set.nrow()}}, set.nrow()}};
  FieldDirections fields(set, path);
  const bool moves = fields.motion(field) != Motion::none;
  if (moves)
    for (const auto& [moving, times] : times_of(set, path, all, {field}))
      all.moving[moving] = {times.used.front(), times.used.back()};
  const FieldCentre centre = usual_centre(fields, set, all, field);
  Meant meant{centre.direction, "", "field " + fields.label(field) + " of " + path};
  if (moves)
    meant.remark = meant.label + " moves: --phasecenter takes where it was in the middle of its rows, at " +
                   utc_text(utc_s(centre.observed)) + "; TRACKFIELD moves along with it";
  return meant;
}

/// Directions of fields that are meant as one differ by no more.
constexpr double meant_as_one_rad = 1e-9;

/// The direction of the fields of one name, which must be in one place. Fields without rows count only if all are without rows.
Meant centre_of_namesakes(const casacore::MeasurementSet& set, const std::string& path, std::vector<int> named,
                          const std::string& text) {
  const auto has_rows = [&](int field) { return first_row_of(set, field).has_value(); };
  if (named.size() > 1 && std::any_of(named.begin(), named.end(), has_rows))
    named.erase(std::remove_if(named.begin(), named.end(), [&](int field) { return !has_rows(field); }), named.end());
  Meant first = centre_in(set, path, named.front());
  for (const int field : named) {
    const double apart_rad = separation_rad(first.direction, centre_in(set, path, field).direction);
    if (apart_rad > meant_as_one_rad)
      throw std::runtime_error("--phasecenter '" + text + "' is the name of fields " + std::to_string(named.front()) + " and " +
                               std::to_string(field) + " of " + path + ", " + angle_words(apart_rad) +
                               " apart; expected one of them by its id");
  }
  return first;
}

/// The field that a text means; nothing where no field of the set has that id or name.
std::optional<Meant> field_meant(const std::string& text, const std::string& path) {
  const casacore::MeasurementSet set = open_measurement_set(path, Access::read);
  return translated("cannot read FIELD of " + path, [&]() -> std::optional<Meant> {
    const std::vector<int> named = fields_in(set, one_line(text));
    if (named.empty() || set.nrow() == 0) return {};
    return centre_of_namesakes(set, path, named, text);
  });
}

[[noreturn]] void refuse(const std::string& text, const std::vector<std::string>& paths) {
  std::string sets;
  casacore::rownr_t count = 0;
  for (const std::string& path : paths) {
    sets += (sets.empty() ? "" : ", ") + path;
    count += open_measurement_set(path, Access::read).field().nrow();
  }
  const std::string fields =
      std::string(paths.size() > 1 ? "one of their " : "one of its ") + std::to_string(count) + " fields by id or name";
  throw std::runtime_error("--phasecenter '" + text +
                           "' is neither a direction, a planet nor the table of an ephemeris, and no field of " + sets +
                           "; expected J2000, ICRS or B1950 with angles such as 12h30m49.4s +12d23m28s or 187.7deg 12.39deg, "
                           "TRACKFIELD, a planet such as JUPITER, the path of an ephemeris, or " +
                           fields);
}

/// The field that a text means in the first set that has it.
std::optional<Meant> field_of_sets(const std::string& text, const std::vector<std::string>& paths) {
  std::optional<Meant> first;
  for (const std::string& path : paths) {
    const std::optional<Meant> one = field_meant(text, path);
    if (!first) {
      first = one;
    } else if (const double apart_rad = one ? separation_rad(first->direction, one->direction) : 0;
               apart_rad > meant_as_one_rad) {
      first->remark += (first->remark.empty() ? "" : "; ") +
                       ("--phasecenter '" + text + "' is " + first->label + ", the first listed that has it: " + one->label +
                        " is " + angle_words(apart_rad) + " away");
    }
  }
  return first;
}

std::optional<Meant> meaning_of(const std::string& text, const std::vector<std::string>& paths) {
  if (const auto direction = parse_direction(text)) return Meant{*direction};
  return field_of_sets(text, paths);
}

bool names_a_field(const std::string& text, const std::string& path) {
  const casacore::MeasurementSet set = open_measurement_set(path, Access::read);
  return translated("cannot read FIELD of " + path, [&] { return !fields_in(set, one_line(text)).empty(); });
}

/// The planet that a text names, in capitals. It goes before fields of that name, and `selection` then says so.
std::string follow_planet(const std::string& text, const std::vector<std::string>& paths, Selection& selection) {
  if (std::any_of(paths.begin(), paths.end(), [&](const std::string& path) { return names_a_field(text, path); }))
    selection.phase_centre_remark =
        "--phasecenter '" + text +
        "' is taken for the body of the solar system, not for the field of that name; its id means the field";
  return capitals(one_line(text));
}

bool is_table(const std::string& path) {
  return !path.empty() && casacore::Table::isReadable(path);
}

}  // namespace

std::optional<imager::SkyDirection> parse_direction(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  imager::SkyDirection direction;
  if (words.size() == 3) {
    direction.frame = frame_named(words.front());
    words.erase(words.begin());
  }
  if (words.size() != 2 || direction.frame.empty()) return {};
  const std::optional<double> ra = angle_rad(words[0]), dec = angle_rad(words[1]);
  constexpr double pole = 1.5707963267948968;
  const bool hours = words[1].find_first_of(":h") != std::string::npos;  // which a declination does not count
  if (!ra || !dec || hours || !(std::abs(*dec) <= pole) || !(std::abs(*ra) <= 4 * pole)) return {};
  direction.ra_rad = std::fmod(std::fmod(*ra, 4 * pole) + 4 * pole, 4 * pole);
  direction.dec_rad = *dec;
  return direction;
}

imager::SkyDirection parse_phase_centre(const std::string& text, const std::string& path) {
  const std::optional<Meant> meant = meaning_of(text, {path});
  if (!meant) refuse(text, {path});
  return meant->direction;
}

Selection phased_to(Selection selection, const std::string& text, const std::vector<std::string>& paths) {
  const bool own = capitals(one_line(text)) == "TRACKFIELD", planet = is_body_name(one_line(text));
  if (own || planet) {
    selection.moving = Selection::Moving::about_targets;
    if (planet) selection.body = follow_planet(text, paths, selection);
    return selection;
  }
  if (const std::optional<Meant> meant = meaning_of(text, paths)) {
    selection.phase_centre = meant->direction;
    selection.phase_centre_remark = meant->remark;
    return selection;
  }
  if (!is_table(text)) refuse(text, paths);
  selection.moving = Selection::Moving::about_targets;
  selection.body = text;
  translated("cannot follow --phasecenter " + text, [&] { make_body(text); });
  return selection;
}

}  // namespace misfit::ms_io
