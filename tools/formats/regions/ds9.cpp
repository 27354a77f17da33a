#include "tools/formats/regions/ds9.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "imager/numerics/constants.h"
#include "tools/base/text.h"
#include "tools/formats/regions/ds9_properties.h"
#include "tools/formats/regions/words.h"

namespace misfit::tools::regions {
namespace {

const std::string shapes_known =
    "circle x y radius, ellipse x y radius radius [angle], box x y width height [angle], polygon x1 y1 x2 y2 x3 y3 …, annulus "
    "x y inner outer, panda x y start stop n inner outer n, epanda or bpanda, or one of the frames image, physical, fk5, fk4, "
    "icrs, galactic, ecliptic";

/// The frame that a word stands for, or nothing; `own` is the image's.
std::optional<std::string> frame_of(const std::string& word, const std::string& own) {
  const std::array<std::pair<const char*, std::string>, 10> frames{{{"image", ""},
                                                                    {"physical", ""},
                                                                    {"fk5", "FK5"},
                                                                    {"j2000", "FK5"},
                                                                    {"fk4", "FK4"},
                                                                    {"b1950", "FK4"},
                                                                    {"icrs", "ICRS"},
                                                                    {"galactic", "GALACTIC"},
                                                                    {"ecliptic", "ECLIPTIC"},
                                                                    {"wcs", own}}};
  for (const auto& [name, frame] : frames)
    if (word == name) return frame;
  return std::nullopt;
}

/// The name of a shape that has no area, which DS9 leaves out of analyses; else empty. A point may have the name of another
/// shape before it, as which it is drawn.
std::string shape_without_area(std::string_view statement) {
  constexpr std::array<std::string_view, 9> drawn{"point", "line",    "vector", "segment", "projection",
                                                  "ruler", "compass", "text",   "textbox"};
  if (statement.starts_with('-') || statement.starts_with('+')) statement.remove_prefix(1);
  std::string first = small_letters(take_word(statement)), second = small_letters(take_word(statement));
  if (second == "point") return second;
  return std::find(drawn.begin(), drawn.end(), first) != drawn.end() ? first : "";
}

/// The arguments of a description, "(1, 2 3)" or "1 2 3"; n=4, which only divides an annulus, is left out.
std::vector<std::string_view> arguments_of_ds9(std::string_view text, std::string_view whole) {
  if (text.starts_with('(')) {
    const std::size_t end = text.find(')');
    if (end == std::string_view::npos) refuse(whole, "a closing parenthesis");
    if (const std::string_view behind = trimmed(text.substr(end + 1)); !behind.empty())
      refuse(behind, "nothing behind a region but properties, which begin with #");
    text = text.substr(1, end - 1);
  }
  std::vector<std::string_view> arguments;
  while (!text.empty()) {
    const std::size_t begin = text.find_first_not_of(", \t");
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(text.find_first_of(", \t", begin), text.size());
    const std::string_view argument = text.substr(begin, end - begin);
    if (!argument.starts_with("n=")) arguments.push_back(argument);
    text.remove_prefix(end);
  }
  return arguments;
}

/// A shape's arguments in a frame.
class Ds9Shape {
 public:
  /// `frame`: empty for pixels. `arguments` are parts of `description`.
  Ds9Shape(const Canvas& canvas, std::string frame, std::string_view description, std::vector<std::string_view> arguments)
      : canvas_(canvas), frame_(std::move(frame)), whole_(description), arguments_(std::move(arguments)) {}

  Shape of(const std::string& name) const {
    if (name == "polygon") return {polygon()};
    if (name.ends_with("panda")) return panda(name);
    if (name == "circle") {
      if (arguments_.size() != 3) refuse(whole_, "circle x y radius");
      return {ellipse({2, 2}, 0)};
    }
    if (arguments_.size() < 4)
      refuse(whole_, name == "box"       ? "box x y width height [angle]"
                     : name == "annulus" ? "annulus x y inner outer"
                                         : "ellipse x y radius radius [angle]");
    const std::size_t each = name == "annulus" ? 1 : 2;
    const double turn_rad = each == 2 && arguments_.size() % 2 == 1 ? angle(arguments_.back()) : 0;
    return rings({2, (arguments_.size() - 2) / each, each}, name == "box", turn_rad);
  }

 private:
  /// The arguments that are lengths along x and y.
  struct Radii {
    std::size_t x;
    std::size_t y;
  };

  /// The arguments that are lengths of outlines, from the inner to the outer: so many, of one or two lengths each.
  struct Rings {
    std::size_t first;
    std::size_t count;
    std::size_t each;

    Radii radii(std::size_t i) const { return {first + i * each, first + i * each + each - 1}; }
  };

  /// The outline of the last lengths without the outline of the first, if there are several.
  Shape rings(const Rings& of, bool boxes, double turn_rad) const {
    const auto draw = [&](Radii r) { return boxes ? Outline(box(r, turn_rad)) : Outline(ellipse(r, turn_rad)); };
    for (std::size_t i = of.first + of.each; i < of.first + of.count * of.each; ++i)
      if (size(i) <= size(i - of.each)) refuse(whole_, "radii that rise from the inner to the outer");
    Shape shape{draw(of.radii(of.count - 1))};
    if (of.count > 1 && size(of.first) != 0) shape.hole = draw(of.radii(0));
    return shape;
  }

  /// Rings within a sector; the numbers of parts in which the viewer shows both do not matter. Where north is turned, DS9 turns
  /// the sector of ellipses and boxes both with them and by itself.
  Shape panda(const std::string& name) const {
    const bool circles = name != "epanda" && name != "bpanda";
    const std::size_t each = circles ? 1 : 2, parts = 5 + 2 * each, count = arguments_.size();
    if (count != parts + 1 && (circles || count != parts + 2))
      refuse(whole_, name + " x y start stop n " + (circles ? "inner outer n" : "inner inner outer outer n [angle]"));
    for (const std::size_t i : {std::size_t{4}, parts}) {
      const double number = number_of(arguments_[i], whole_, "whole numbers of sectors and rings");
      if (!(number >= 1) || number != std::floor(number)) refuse(whole_, "1 sector and 1 ring at least");
    }
    const double turn_rad = count == parts + 2 ? angle(arguments_.back()) : 0, north_rad = canvas_.north_rad(centre());
    const double from_rad = angle(arguments_[2]), whole_turn = 2 * imager::pi;
    const double span_rad = std::fmod(std::fmod(angle(arguments_[3]) - from_rad, whole_turn) + whole_turn, whole_turn);
    Shape shape = rings({5, 2, each}, name == "bpanda", turn_rad);
    shape.sector = {canvas_.point(centre()), from_rad + north_rad + (circles ? 0 : turn_rad + north_rad),
                    span_rad < 1e-7 ? whole_turn : span_rad};  // from 0 to 360, or to where it begins
    return shape;
  }

  Ellipse ellipse(Radii r, double turn_rad) const {
    return {canvas_.point(centre()), pixels(r.x), pixels(r.y), canvas_.north_rad(centre()) + turn_rad};
  }

  Polygon box(Radii r, double turn_rad) const {
    return polygon_of({canvas_.point(centre()), pixels(r.x), pixels(r.y), canvas_.north_rad(centre()) + turn_rad});
  }

  Polygon polygon() const {
    if (arguments_.size() < 6 || arguments_.size() % 2 == 1) refuse(whole_, "polygon x1 y1 x2 y2 x3 y3 …");
    Polygon polygon;
    for (std::size_t i = 0; i < arguments_.size(); i += 2)
      polygon.corners.push_back(canvas_.point(place(arguments_[i], arguments_[i + 1])));
    return polygon;
  }

  Place centre() const { return place(arguments_[0], arguments_[1]); }
  Place place(std::string_view x, std::string_view y) const {
    const std::string frame = frame_.empty() ? canvas_.frame() : frame_;
    return {coordinate(x, has_right_ascensions(frame)), coordinate(y, false), frame, std::string(x) + ", " + std::string(y)};
  }

  /// `colons_are_hours`: of a right ascension.
  Quantity coordinate(std::string_view text, bool colons_are_hours) const {
    const std::string expected = "a coordinate such as 100, 187.7d, 3.2r, 100i, 12:30:49.4, 12h30m49.4s or 12d23m28s";
    if (ms_io::is_sexagesimal(text) && text.find_first_of("hd:") != std::string_view::npos)
      return {false, sexagesimal(text, colons_are_hours ? ms_io::Colons::hours : ms_io::Colons::degrees, expected)};
    Quantity q = number_with_unit(text, "dr", expected);
    if (q.pixels) q.value -= 1;
    return q;
  }

  Quantity length(std::size_t i) const {
    return number_with_unit(arguments_[i], "\"'dr", "a length such as 10, 10\", 0.5', 0.1d, 0.01r or 20i");
  }
  double pixels(std::size_t i) const { return canvas_.pixels(length(i), arguments_[i]); }

  /// A length in pixels, or 0, as an inner radius may be.
  double size(std::size_t i) const { return length(i).value == 0 ? 0 : pixels(i); }

  /// A number alone, in pixels (i, p), or with one of these units of angles.
  Quantity number_with_unit(std::string_view text, std::string_view units, const std::string& expected) const {
    const char unit = text.empty() ? '\0' : text.back();
    const bool pixels = unit == 'i' || unit == 'p', angle = units.find(unit) != std::string_view::npos;
    const double value = number_of(text.substr(0, text.size() - (pixels || angle ? 1 : 0)), text, expected);
    if (pixels) return {true, value};
    if (!angle) return {frame_.empty(), frame_.empty() ? value : value * degree};
    const double size = unit == '"' ? degree / 3600 : unit == '\'' ? degree / 60 : unit == 'd' ? degree : 1;
    return {false, value * size};
  }

  double angle(std::string_view text) const {
    const bool unit = text.ends_with('d') || text.ends_with('r');
    const double value = number_of(text.substr(0, text.size() - (unit ? 1 : 0)), text, "an angle in degrees, or such as 0.5r");
    return text.ends_with('r') ? value : value * degree;
  }

  const Canvas& canvas_;
  std::string frame_;
  std::string_view whole_;
  std::vector<std::string_view> arguments_;
};

}  // namespace

bool is_ds9_frame(const std::string& word) {
  return frame_of(word, "").has_value();
}

Ds9Reader::Ds9Reader(const imager::ImageHeader& image)
    : canvas_(image.geometry), stokes_(image.stokes.size(), true), channels_{0, image.spectral.channels - 1} {}

RegionLine Ds9Reader::read(std::string_view line) {
  RegionLine found;
  if (line.starts_with('#')) return found;  // parts of a composite region, which such a line begins, are regions as others
  for (const std::string_view statement : ds9_statements(line)) read_statement(statement, found);
  return found;
}

void Ds9Reader::read_statement(std::string_view statement, RegionLine& found) {
  std::string_view rest = statement;
  const std::string word = small_letters(take_word(rest));
  if (word == "global") {
    const Ds9Properties global = parse_ds9_properties(rest);
    included_ = global.included.value_or(included_);
    background_ = global.background.value_or(background_);
    return;
  }
  if (const auto frame = frame_of(word, canvas_.frame()); frame && (rest.empty() || rest.starts_with('#'))) {
    frame_ = *frame;
    return;
  }
  if (word == "tile" && rest == "1") return;
  if (const std::string drawn = shape_without_area(statement); !drawn.empty()) {
    found.passed_over.push_back(drawn);
    return;
  }
  const auto [description, properties] = split_ds9_properties(statement);
  const Ds9Properties own = parse_ds9_properties(properties);
  if (own.background.value_or(background_))
    refuse(statement, "a source: what is background is nothing to find components in; take the region out, or write source");
  Region region = read_shape(description);
  region.added = region.added && own.included.value_or(included_);
  found.regions.push_back(std::move(region));
}

Region Ds9Reader::read_shape(std::string_view description) const {
  std::string_view rest = description;
  while (rest.ends_with('|') || rest.ends_with(' ')) rest.remove_suffix(1);  // "||" joins the parts of a composite region
  Region region;
  region.added = !rest.starts_with('-');
  if (rest.starts_with('-') || rest.starts_with('+')) rest.remove_prefix(1);
  const std::string name = small_letters(take_word(rest));
  constexpr std::array<std::string_view, 9> areas{"circle", "ellipse", "box",    "polygon", "annulus",
                                                  "panda",  "cpanda",  "epanda", "bpanda"};
  if (std::find(areas.begin(), areas.end(), name) == areas.end()) refuse(description, shapes_known);
  region.shape = Ds9Shape(canvas_, frame_, description, arguments_of_ds9(rest, description)).of(name);
  region.channels = channels_;
  region.stokes = stokes_;
  return region;
}

}  // namespace misfit::tools::regions
