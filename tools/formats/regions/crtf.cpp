#include "tools/formats/regions/crtf.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "tools/base/quantity.h"
#include "tools/base/text.h"
#include "tools/formats/regions/spectral_range.h"
#include "tools/formats/regions/words.h"

namespace misfit::tools::regions {
namespace {

/// "100pix", or an angle with its unit.
Quantity crtf_quantity(std::string_view text, const std::string& expected) {
  if (text.ends_with("pix")) return {true, number_of(text.substr(0, text.size() - 3), text, expected)};
  if (!has_unit(std::string(text))) refuse(text, expected);
  return {false, parse_angle_rad(std::string(text))};
}

Quantity longitude(std::string_view text, const std::string& frame) {
  const bool hours = has_right_ascensions(frame);
  const std::string expected = hours
                                   ? "a right ascension such as 12h30m49.4s, 12:30:49.4 or 187.7deg, or a column such as 100pix"
                                   : "a longitude such as 120.47deg, 120d28m03s or 120.28.03.0, or a column such as 100pix";
  if (!ms_io::is_sexagesimal(text)) return crtf_quantity(text, expected);
  const bool colons = text.find(':') != std::string_view::npos;
  const bool dots = !colons && text.find_first_of("hd") == std::string_view::npos;
  if (hours ? dots : colons) refuse(text, expected);  // hours or degrees, nobody knows
  return {false, sexagesimal(text, ms_io::Colons::hours, expected)};
}

Quantity latitude(std::string_view text) {
  const std::string expected = "a declination such as +12d23m28s, +12.23.28.0 or 12.39deg, or a row such as 100pix";
  if (!ms_io::is_sexagesimal(text)) return crtf_quantity(text, expected);
  if (text.find_first_of("h:") != std::string_view::npos) refuse(text, expected);
  return {false, sexagesimal(text, ms_io::Colons::degrees, expected)};
}

std::string_view unquoted(std::string_view text) {
  if (text.size() >= 2 && (text.front() == '\'' || text.front() == '"') && text.back() == text.front())
    return trimmed(text.substr(1, text.size() - 2));
  return text;
}

/// [[a, b], [c, d], e] as {{a, b}, {c, d}, {e}}. Refuses what has no such brackets.
std::vector<std::vector<std::string_view>> arguments_of(std::string_view text, const std::string& expected) {
  std::vector<std::vector<std::string_view>> arguments;
  std::string_view rest = trimmed(text.substr(1, text.size() - 2));
  while (!rest.empty()) {
    const bool pair = rest.starts_with('[');
    const std::size_t end = std::min(rest.find(pair ? ']' : ','), rest.size());
    if (pair && end == rest.size()) refuse(text, expected);
    std::vector<std::string_view> parts = split_at_commas(rest.substr(pair ? 1 : 0, end - (pair ? 1 : 0)));
    for (std::string_view& part : parts) {
      part = unquoted(part);
      if (part.empty() || part.find_first_of("[]") != std::string_view::npos) refuse(text, expected);
    }
    arguments.push_back(std::move(parts));
    rest = trimmed(rest.substr(std::min(end + (pair ? 1 : 0), rest.size())));
    if (rest.empty()) break;
    if (!rest.starts_with(',') || trimmed(rest.substr(1)).empty()) refuse(text, expected);
    rest = trimmed(rest.substr(1));
  }
  return arguments;
}

/// The text up to the bracket that closes its first one, and the text behind it.
std::pair<std::string_view, std::string_view> split_at_closing(std::string_view text, const std::string& expected) {
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    depth += text[i] == '[' ? 1 : text[i] == ']' ? -1 : 0;
    if (text[i] == ']' && depth == 0) return {text.substr(0, i + 1), text.substr(i + 1)};
  }
  refuse(text, expected);
}

/// The form of shapes: pairs come before single arguments.
struct Form {
  std::string_view name;
  std::string_view other_name;
  std::size_t pairs;
  std::size_t singles;
  std::string_view written;
};
constexpr std::array<Form, 7> forms{{
    {"box", "rectangularbox", 2, 0, "box [[x1, y1], [x2, y2]]"},
    {"centerbox", "", 2, 0, "centerbox [[x, y], [width, height]]"},
    {"rotbox", "rotatedbox", 2, 1, "rotbox [[x, y], [width, height], angle]"},
    {"poly", "polygon", 3, 0, "poly [[x1, y1], [x2, y2], [x3, y3], …]"},
    {"circle", "", 1, 1, "circle [[x, y], radius]"},
    {"annulus", "", 2, 0, "annulus [[x, y], [inner radius, outer radius]]"},
    {"ellipse", "", 2, 1, "ellipse [[x, y], [half axis, other half axis], angle]"},
}};

std::string written_forms() {
  std::string all;
  for (const Form& form : forms) all += (all.empty() ? "" : ", ") + std::string(form.written);
  return all;
}

const Form& form_of(std::string_view name, std::string_view text) {
  const std::string small = small_letters(name);
  for (const Form& form : forms)
    if (small == form.name || (small == form.other_name && !small.empty())) return form;
  refuse(text, "one of " + written_forms() + ", or global or ann before it");
}

/// A shape's arguments, of a known form.
class CrtfShape {
 public:
  CrtfShape(const Canvas& canvas, std::string frame, std::vector<std::vector<std::string_view>> arguments)
      : canvas_(canvas), frame_(std::move(frame)), arguments_(std::move(arguments)) {}

  Shape of(std::string_view name) const {
    if (name == "box") return {box()};
    if (name == "centerbox") return {polygon_of(rectangle(0))};
    if (name == "rotbox") return {polygon_of(rectangle(angle(2)))};
    if (name == "poly") return {polygon()};
    if (name == "circle") return {circle(arguments_[1][0])};
    if (name == "annulus") return annulus();
    const Place centre = place(0);
    const double y_radius = length(arguments_[1][0]), x_radius = length(arguments_[1][1]);
    return {Ellipse{canvas_.point(centre), x_radius, y_radius, canvas_.north_rad(centre) + angle(2)}};
  }

 private:
  Place place(std::string_view x, std::string_view y) const {
    return {longitude(x, frame_), latitude(y), frame_, std::string(x) + ", " + std::string(y)};
  }
  Place place(std::size_t i) const { return place(arguments_[i][0], arguments_[i][1]); }

  Quantity quantity(std::string_view text) const { return crtf_quantity(text, "a length such as 10arcsec or 20pix"); }
  double length(std::string_view text) const { return canvas_.pixels(quantity(text), text); }

  double angle(std::size_t i) const {
    const std::string expected = "an angle such as 30deg or 0.5rad";
    const Quantity turn = crtf_quantity(arguments_[i][0], expected);
    if (turn.pixels) refuse(arguments_[i][0], expected);
    return turn.value;
  }

  Polygon box() const {
    const auto &one = arguments_[0], &other = arguments_[1];
    Polygon corners;
    for (const auto& [x, y] : {std::pair(one[0], one[1]), {other[0], one[1]}, {other[0], other[1]}, {one[0], other[1]}})
      corners.corners.push_back(canvas_.point(place(x, y)));
    return corners;
  }

  Polygon polygon() const {
    Polygon polygon;
    for (std::size_t i = 0; i < arguments_.size(); ++i) polygon.corners.push_back(canvas_.point(place(i)));
    return polygon;
  }

  Rectangle rectangle(double turn_rad) const {
    const Place centre = place(0);
    return {canvas_.point(centre), length(arguments_[1][0]), length(arguments_[1][1]), canvas_.north_rad(centre) + turn_rad};
  }

  Ellipse circle(std::string_view radius) const { return {canvas_.point(place(0)), length(radius), length(radius), 0}; }

  Shape annulus() const {
    const std::string_view inner = arguments_[1][0], outer = arguments_[1][1];
    Shape shape{circle(outer)};
    if (quantity(inner).value == 0) return shape;
    if (!(length(inner) < length(outer))) refuse(std::string(inner) + ", " + std::string(outer), "the inner radius first");
    shape.hole = circle(inner);
    return shape;
  }

  const Canvas& canvas_;
  std::string frame_;
  std::vector<std::vector<std::string_view>> arguments_;
};

bool fits(const Form& form, const std::vector<std::vector<std::string_view>>& arguments) {
  const auto pairs = static_cast<std::size_t>(
      std::count_if(arguments.begin(), arguments.end(), [](const auto& argument) { return argument.size() == 2; }));
  const bool many = form.name == "poly";
  if (many ? pairs < form.pairs : pairs != form.pairs) return false;
  if (arguments.size() != pairs + form.singles) return false;
  return form.singles == 0 || arguments.back().size() == 1;
}

/// Refuses keywords that mean nothing for any image.
void check_meaning(const RegionKeywords& keywords) {
  spectral_range(keywords);
  stokes_of_corr(keywords, {});
  frame_of_coord(keywords, "");
}

void check_version(std::string_view line) {
  std::string_view version = line.substr(std::string_view("#CRTF").size());
  if (version.starts_with('v')) version.remove_prefix(1);
  const std::string_view digits = version.substr(0, version.find_first_not_of("0123456789"));
  if (digits.find_first_not_of('0') != std::string_view::npos) refuse(line, "version 0, which is all there is: #CRTFv0");
}

}  // namespace

CrtfReader::CrtfReader(const imager::ImageHeader& image)
    : canvas_(image.geometry), axis_(image.spectral), stokes_(image.stokes) {}

RegionLine CrtfReader::read(std::string_view line) {
  if (line.starts_with("#CRTF")) check_version(line);
  if (line.empty() || line.starts_with('#')) return {};
  std::string_view rest = line;
  const std::string word = small_letters(take_word(rest));
  if (word == "ann") return {};  // annotations are for the eye
  for (const char* shape : {"symbol", "line", "polyline", "vector", "text"})
    if (word == shape) return {{}, {word}};
  if (word != "global") return read_shape(line);
  for (const auto& [name, value] : parse_region_keywords(rest)) global_[name] = value;
  check_meaning(global_);  // what is wrong with them is said on this line
  return {};
}

RegionLine CrtfReader::read_shape(std::string_view line) const {
  Region region;
  std::string_view rest = line;
  region.added = !line.starts_with('-');
  if (line.starts_with('-') || line.starts_with('+')) rest.remove_prefix(1);
  const Form& form = form_of(take_word(rest), line);
  if (!rest.starts_with('[')) refuse(line, std::string(form.written));
  const auto [text, behind] = split_at_closing(rest, std::string(form.written));
  RegionKeywords keywords = parse_region_keywords(behind);
  keywords.insert(global_.begin(), global_.end());
  const auto arguments = arguments_of(text, std::string(form.written));
  if (!fits(form, arguments)) refuse(line, std::string(form.written));
  region.shape = CrtfShape(canvas_, frame_of_coord(keywords, canvas_.frame()), arguments).of(form.name);
  region.channels = planes_of_range(keywords, axis_);
  region.stokes = stokes_of_corr(keywords, stokes_);
  for (const char* name : {"corr", "range"})
    if (const auto found = keywords.find(name); found != keywords.end())
      region.planes += (region.planes.empty() ? "" : ", ") + found->first + "=" + found->second;
  return {{region}, {}};
}

}  // namespace misfit::tools::regions
