#include "tools/formats/region_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "tools/base/numbers.h"
#include "tools/base/quantity.h"
#include "tools/base/text.h"

namespace misfit::tools {
namespace {

constexpr double degree = M_PI / 180;
const std::string regions_known =
    "expected box [[x, y], [x, y]], centerbox [[x, y], [width, height]] or circle [[x, y], radius]";

[[noreturn]] void expected(std::string_view text, const std::string& what) {
  throw std::runtime_error("'" + std::string(text) + "', expected " + what);
}

double number(std::string_view text, std::string_view whole, const std::string& what) {
  const std::optional<double> value = finite_number(text);
  if (!value) expected(whole, what);
  return *value;
}

/// "12h30m49.4s", "12:30:49.4", "12d23m28s" or "12.23.28.0" in units of its first part, which ends with `first`, the second
/// with `second`.
double parse_sexagesimal(std::string_view text, char first, char second, const std::string& what) {
  const bool negative = text.starts_with('-');
  std::string_view rest = text.substr(negative || text.starts_with('+') ? 1 : 0);
  const auto whole_part = [&](char end) {
    const std::size_t digits = rest.find_first_not_of("0123456789");
    if (digits == 0 || digits == std::string_view::npos || rest[digits] != end) expected(text, what);
    const double value = number(rest.substr(0, digits), text, what);
    rest.remove_prefix(digits + 1);
    return value;
  };
  const double units = whole_part(first), minutes = whole_part(second);
  if (second == 'm') {
    if (!rest.ends_with('s')) expected(text, what);
    rest.remove_suffix(1);
  }
  if (rest.empty() || std::isdigit(static_cast<unsigned char>(rest.front())) == 0) expected(text, what);
  const double seconds = number(rest, text, what);
  if (minutes >= 60 || seconds >= 60) expected(text, what);
  const double value = units + minutes / 60 + seconds / 3600;
  return negative ? -value : value;
}

/// A place along one axis, or a length: in pixels, or on the sky.
struct Quantity {
  bool pixels = false;
  double value = 0;  ///< pixels or radians
};

Quantity plain_quantity(std::string_view text, const std::string& what) {
  if (text.ends_with("pix")) return {true, number(text.substr(0, text.size() - 3), text, what)};
  const bool has_unit = !text.empty() && std::isalpha(static_cast<unsigned char>(text.back())) != 0;
  if (!has_unit) expected(text, what);
  return {false, parse_angle_rad(std::string(text))};
}

Quantity right_ascension(std::string_view text) {
  const std::string what = "a right ascension such as 12h30m49.4s, 12:30:49.4 or 187.7deg, or a column such as 100pix";
  if (text.find('h') != std::string_view::npos) return {false, 15 * degree * parse_sexagesimal(text, 'h', 'm', what)};
  if (text.find(':') != std::string_view::npos) return {false, 15 * degree * parse_sexagesimal(text, ':', ':', what)};
  return plain_quantity(text, what);
}

Quantity declination(std::string_view text) {
  const std::string what = "a declination such as +12d23m28s, +12.23.28.0 or 12.39deg, or a row such as 100pix";
  if (text.ends_with('s')) return {false, degree * parse_sexagesimal(text, 'd', 'm', what)};
  if (std::count(text.begin(), text.end(), '.') >= 2) return {false, degree * parse_sexagesimal(text, '.', '.', what)};
  return plain_quantity(text, what);
}

/// A place in an image, in pixels.
struct Place {
  double column;
  double row;
};

Place place(std::string_view x, std::string_view y, const imager::ImageGeometry& g) {
  const Quantity ra = right_ascension(x), dec = declination(y);
  if (ra.pixels != dec.pixels) expected(std::string(x) + ", " + std::string(y), "both in pixels or both on the sky");
  if (ra.pixels) return {ra.value, dec.value};
  if (std::abs(dec.value) > 90 * degree) expected(y, "-90 to 90 degrees");
  const imager::DirectionCosines at = imager::direction_cosines({ra.value, dec.value, g.phase_centre.frame}, g.phase_centre);
  return {g.centre_column() - (at.l - g.centre.l) / g.cell_rad, g.centre_row() + (at.m - g.centre.m) / g.cell_rad};
}

double length(std::string_view text, const imager::ImageGeometry& g) {
  const Quantity q = plain_quantity(text, "a length such as 10arcsec or 20pix");
  if (!(q.value > 0)) expected(text, "a length above 0");
  return q.pixels ? q.value : q.value / g.cell_rad;
}

/// What stands between the outermost brackets, without the inner ones, at commas.
std::vector<std::string_view> arguments(std::string_view text) {
  const std::size_t open = text.find('['), close = text.rfind(']');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) return {};
  std::vector<std::string_view> parts;
  std::string_view rest = text.substr(open + 1, close - open - 1);
  while (!rest.empty()) {
    const std::size_t end = rest.find_first_of("[],");
    if (const std::string_view part = trimmed(rest.substr(0, end)); !part.empty()) parts.push_back(part);
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  return parts;
}

/// The region's text up to the bracket that closes it, and the keywords behind.
std::pair<std::string_view, std::string_view> split_keywords(std::string_view line) {
  int depth = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    depth += line[i] == '[' ? 1 : line[i] == ']' ? -1 : 0;
    if (line[i] == ']' && depth == 0) return {line.substr(0, i + 1), line.substr(i + 1)};
  }
  return {line, {}};
}

void check_frame(const RegionKeywords& keywords, const std::string& frame) {
  const auto coord = keywords.find("coord");
  const std::string here = frame == "FK5" ? "J2000" : frame == "FK4" ? "B1950" : frame;
  if (coord != keywords.end() && coord->second != here) expected("coord=" + coord->second, "the image's frame, " + here);
}

}  // namespace

RegionText::RegionText(const std::string& path, std::string_view text, const imager::ImageHeader& image)
    : geometry_(image.geometry), axis_(image.spectral) {
  if (text.find('\0') != std::string_view::npos)
    throw std::runtime_error(path + " is neither a FITS image, a CASA image nor region text");
  int line_number = 0;
  try {
    while (!text.empty()) {
      ++line_number;
      const std::size_t end = text.find_first_of("\r\n");
      const std::string_view line = trimmed(text.substr(0, end));
      if (const std::string control = control_character_of(line); !control.empty())
        throw std::runtime_error("it has " + control + ", expected text");
      read_line(line);
      if (end == std::string_view::npos) break;
      text.remove_prefix(end + (text.substr(end).starts_with("\r\n") ? 2 : 1));
    }
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ", line " + std::to_string(line_number) + ": " + error.what());
  }
  if (regions_.empty()) throw std::runtime_error(path + " holds no region; " + regions_known);
}

void RegionText::read_line(std::string_view line) {
  constexpr std::string_view global = "global";
  if (line.empty() || line.starts_with('#') || line.starts_with("ann ") || line.starts_with("ann\t")) return;
  if (line.starts_with(global)) {
    for (const auto& [name, value] : parse_region_keywords(line.substr(global.size()))) global_[name] = value;
    return check_frame(global_, geometry_.phase_centre.frame);
  }
  const auto [text, rest] = split_keywords(line);
  if (!trimmed(rest).empty() && !trimmed(rest).starts_with(',')) expected(trimmed(rest), "a comma and keywords");
  RegionKeywords keywords = parse_region_keywords(rest);
  keywords.insert(global_.begin(), global_.end());
  check_frame(keywords, geometry_.phase_centre.frame);
  Region region = parse_region(text);
  region.planes = planes_of_range(keywords, axis_);
  regions_.push_back(region);
}

RegionText::Region RegionText::parse_region(std::string_view text) const {
  Region region;
  region.added = !text.starts_with('-');
  std::string_view shape = text.substr(!region.added || text.starts_with('+') ? 1 : 0);
  const std::vector<std::string_view> a = arguments(shape);
  shape = trimmed(shape.substr(0, shape.find('[')));
  region.circle = shape == "circle" && a.size() == 3;
  if (shape == "box" && a.size() == 4) {
    const Place one = place(a[0], a[1], geometry_), other = place(a[2], a[3], geometry_);
    std::tie(region.low_column, region.high_column) = std::minmax(one.column, other.column);
    std::tie(region.low_row, region.high_row) = std::minmax(one.row, other.row);
  } else if (region.circle || (shape == "centerbox" && a.size() == 4)) {
    const Place centre = place(a[0], a[1], geometry_);
    const double x = length(a[2], geometry_) / (region.circle ? 1 : 2), y = region.circle ? x : length(a[3], geometry_) / 2;
    std::tie(region.low_column, region.high_column) = std::pair(centre.column - x, centre.column + x);
    std::tie(region.low_row, region.high_row) = std::pair(centre.row - y, centre.row + y);
  } else {
    throw std::runtime_error("'" + std::string(text) + "', " + regions_known);
  }
  return region;
}

bool RegionText::one_for_all_channels() const {
  return std::all_of(regions_.begin(), regions_.end(),
                     [&](const Region& r) { return r.planes.first == 0 && r.planes.last == axis_.channels - 1; });
}

imager::Image RegionText::mask(int channel) const {
  const auto first = [](double x) { return static_cast<int>(std::ceil(std::clamp(x, 0.0, 1e6))); };
  const auto last = [](double x, int size) { return static_cast<int>(std::floor(std::clamp(x, -1.0, size - 1.0))); };
  imager::Image mask(geometry_.width, geometry_.height);
  for (const Region& region : regions_) {
    if (!region.planes.holds(channel)) continue;
    const double column = 0.5 * (region.low_column + region.high_column), row = 0.5 * (region.low_row + region.high_row);
    const double radius = 0.5 * (region.high_column - region.low_column);
    for (int r = first(region.low_row); r <= last(region.high_row, mask.height); ++r)
      for (int c = first(region.low_column); c <= last(region.high_column, mask.width); ++c)
        if (!region.circle || std::hypot(c - column, r - row) <= radius) mask.at(r, c) = region.added ? 1 : 0;
  }
  return mask;
}

}  // namespace misfit::tools
