#include <casacore/casa/Quanta/MVAngle.h>
#include <casacore/casa/Quanta/Quantum.h>
#include <casacore/measures/Measures/MDirection.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <sstream>

#include "ms_io/field_centres_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/sexagesimal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

std::string capitals(std::string text) {
  for (char& letter : text) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return text;
}

/// FITS RADESYS of a frame's name in CASA; empty for others.
std::string frame_named(const std::string& of) {
  const std::string name = capitals(of);
  return name == "J2000" ? "FK5" : name == "ICRS" ? "ICRS" : name == "B1950" ? "FK4" : "";
}

/// The angle, which must have a unit or be sexagesimal.
std::optional<double> angle_rad(const std::string& text) {
  if (is_sexagesimal(text)) return sexagesimal_rad(text, Colons::hours, Parts::some);
  // Of units of time, which casacore takes for angles, none but the hour is meant for one.
  const std::string unit = text.substr(std::min(text.find_last_of("0123456789.") + 1, text.size()));
  casacore::Quantity angle;
  if (unit.empty() || unit == "s" || unit == "m" || !casacore::MVAngle::read(angle, text)) return {};
  if (!angle.isConform("rad") && unit != "h") return {};
  return angle.getValue("rad");
}

std::optional<imager::SkyDirection> direction_in(const std::string& text) {
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

/// The field with that id or name.
std::optional<int> field_in(const casacore::MeasurementSet& set, const std::string& text) {
  const auto names = casacore::ScalarColumn<casacore::String>(set.field(), "NAME").getColumn().tovector();
  const auto named = std::find(names.begin(), names.end(), casacore::String(text));
  if (named != names.end()) return static_cast<int>(named - names.begin());
  const bool number = !text.empty() && text.size() < 9 && text.find_first_not_of("0123456789") == std::string::npos;
  if (number && std::stoul(text) < names.size()) return std::stoi(text);
  return {};
}

/// The first row of the field; 0 where it has none.
std::uint64_t first_row_of(const casacore::MeasurementSet& set, int field) {
  const casacore::ScalarColumn<int> fields(set, "FIELD_ID");
  for (std::uint64_t row = 0; row < set.nrow(); ++row) {
    if (fields(row) == field) return row;
  }
  return 0;
}

/// The direction that a text means.
struct Meant {
  imager::SkyDirection direction;
  std::string remark;  ///< empty, but of a field that moves
};

/// Where a field is phased to and, where that moves, in the middle of its rows.
Meant centre_in(const casacore::MeasurementSet& set, const std::string& path, int field) {
  SelectedRows all;
  all.first_row = first_row_of(set, field);
  all.first_row_of_field[field] = all.first_row;
  all.blocks = {{0, {{0, set.nrow()}}, set.nrow()}};
  FieldDirections fields(set, path);
  const bool moves = fields.motion(field) != Motion::none;
  const auto times = moves ? times_of(set, path, all, {field}) : std::map<int, std::vector<double>>();
  for (const auto& [moving, times_s] : times) all.moving[moving] = {times_s.front(), times_s.back()};
  const FieldCentre centre = usual_centre(fields, set, all, field);
  if (!moves) return {centre.direction, ""};
  return {centre.direction, "field " + fields.label(field) + " of " + path +
                                " moves: --phasecenter takes where it was in the middle of its rows, at " +
                                utc_text(utc_s(centre.observed)) + "; TRACKFIELD moves along with it"};
}

Meant meaning_of(const std::string& text, const std::string& path) {
  if (const auto direction = direction_in(text)) return {*direction, ""};
  const casacore::MeasurementSet set = open_measurement_set(path, Access::read);
  const auto field = translated("cannot read FIELD of " + path, [&] { return field_in(set, one_line(text)); });
  if (field && set.nrow() > 0) return translated("cannot read FIELD of " + path, [&] { return centre_in(set, path, *field); });
  casacore::MDirection::Types type = casacore::MDirection::J2000;
  const bool body = casacore::MDirection::getType(type, capitals(one_line(text))) && type >= casacore::MDirection::MERCURY;
  const std::string fields = "one of its " + std::to_string(set.field().nrow()) + " fields by id or name";
  if (body)
    throw std::runtime_error("--phasecenter '" + text +
                             "' is a body of the solar system, whose place is not looked up; expected TRACKFIELD, which images "
                             "fields that follow an ephemeris about what they follow, a direction, or " +
                             fields);
  throw std::runtime_error("--phasecenter '" + text + "' is neither a direction nor a field of " + path +
                           "; expected J2000, ICRS or B1950 with angles such as 12h30m49.4s +12d23m28s or 187.7deg 12.39deg, "
                           "TRACKFIELD, or " +
                           fields);
}

}  // namespace

imager::SkyDirection parse_phase_centre(const std::string& text, const std::string& path) {
  return meaning_of(text, path).direction;
}

Selection phased_to(Selection selection, const std::string& text, const std::string& path) {
  if (capitals(one_line(text)) == "TRACKFIELD") {
    selection.moving = Selection::Moving::about_targets;
    return selection;
  }
  const Meant meant = meaning_of(text, path);
  selection.phase_centre = meant.direction;
  selection.phase_centre_remark = meant.remark;
  return selection;
}

}  // namespace misfit::ms_io
