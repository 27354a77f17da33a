#include "tools/formats/component_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "ms_io/celestial_frames.h"
#include "tools/base/files.h"
#include "tools/base/numbers.h"
#include "tools/base/text.h"

namespace misfit::tools {
namespace {

using imager::Source;

constexpr double degree = M_PI / 180;
constexpr double arcsec = degree / 3600;
constexpr std::array<std::string_view, 4> flux_names{"flux_jy", "flux_q_jy", "flux_u_jy", "flux_v_jy"};

/// The fluxes that a list may have.
enum class Polarised { no, yes };

[[noreturn]] void fail(const std::string& message) {
  throw std::runtime_error(message);
}

/// Text of a file, quoted and short enough for a line of a message.
std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, longest)) result += static_cast<unsigned char>(c) < ' ' || c == '\x7f' ? '?' : c;
  return result + (text.size() > longest ? "…'" : "'");
}

using Fields = std::vector<std::string_view>;

/// The column of each quantity in a line.
class Columns {
 public:
  Columns(std::string_view line, Polarised polarised) : names_(split_at_commas(line)) {
    if (names_.size() == 1 && line.find(';') != line.npos) fail("columns are separated by ';', " + expected());
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const bool is_flux = polarised == Polarised::yes && std::count(flux_names.begin(), flux_names.end(), names_[i]) > 0;
      if (!is_flux && std::find(known.begin(), known.end(), names_[i]) == known.end())
        fail("unknown column " + quoted(names_[i]) + ", " + expected());
      if (place(names_[i]) != i) fail("column " + quoted(names_[i]) + " appears twice, " + expected());
    }
    equatorial = has("ra_deg") || has("dec_deg");
    for (const std::string_view name : {equatorial ? "ra_deg" : "l_arcsec", equatorial ? "dec_deg" : "m_arcsec", "flux_jy"})
      if (!has(name)) fail("no column " + quoted(name) + ", " + expected());
    if (equatorial && (has("l_arcsec") || has("m_arcsec"))) fail("positions are given twice, " + expected());
    if (has("frame") && !equatorial) fail("column 'frame' stands without ra_deg and dec_deg, " + expected());
    if (has("spectral_index") != has("reference_frequency_hz"))
      fail("no column " + quoted(has("spectral_index") ? "reference_frequency_hz" : "spectral_index") +
           ", expected both or neither of spectral_index and reference_frequency_hz");
  }

  static std::string expected() {
    return "expected the columns ra_deg,dec_deg,flux_jy, with frame if it is not the phase centre's; or "
           "l_arcsec,m_arcsec,flux_jy; "
           "either with scale_arcsec if sources are extended, and with spectral_index,reference_frequency_hz if fluxes depend "
           "on "
           "frequency";
  }
  std::size_t count() const { return names_.size(); }
  bool has(std::string_view name) const { return place(name) < names_.size(); }
  std::size_t place(std::string_view name) const {
    return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  }

  bool equatorial = false;

 private:
  static constexpr std::array<std::string_view, 9> known{"ra_deg",  "dec_deg",      "l_arcsec",       "m_arcsec",
                                                         "flux_jy", "scale_arcsec", "spectral_index", "reference_frequency_hz",
                                                         "frame"};

  Fields names_;
};

/// A line of values.
class Line {
 public:
  Line(std::string_view text, const Columns& columns) : columns_(columns), fields_(split_at_commas(text)) {
    if (fields_.size() != columns.count())
      fail("the line has " + std::to_string(fields_.size()) + " values, expected " + std::to_string(columns.count()) +
           ", one for each column");
  }

  /// A number of the line. Throws unless it is finite and from `least` to `most`.
  double number(std::string_view name, double least, double most, const std::string& expected) const {
    const std::optional<double> value = finite_number(field(name));
    if (!value || *value < least || *value > most)
      fail(std::string(name) + " is " + quoted(field(name)) + ", expected " + expected);
    return *value;
  }
  double number(std::string_view name) const {
    constexpr double any = std::numeric_limits<double>::max();
    return number(name, -any, any, "a finite number");
  }
  std::string shown(std::string_view x, std::string_view y) const {
    return std::string(x) + " " + quoted(field(x)) + ", " + std::string(y) + " " + quoted(field(y));
  }

  /// FITS RADESYS of the line's frame; empty where the list does not state it.
  std::string frame() const {
    if (!columns_.has("frame")) return "";
    for (const auto& [listed, radesys] : frames_of_lists)
      if (field("frame") == listed) return radesys;
    fail("frame is " + quoted(field("frame")) + ", expected J2000, ICRS or B1950");
  }

  Source source(const imager::SkyDirection& phase_centre, std::string_view flux = flux_names[0]) const {
    const double scale_arcsec = columns_.has("scale_arcsec") ? number("scale_arcsec", 0, std::numeric_limits<double>::max(),
                                                                      "a full width at half maximum, 0 (a point) or more")
                                                             : 0;
    Source source{columns_.equatorial ? equatorial_position(phase_centre) : tangent_position(), number(flux),
                  scale_arcsec * arcsec};
    if (!columns_.has("spectral_index")) return source;
    source.spectral_index = number("spectral_index");
    source.reference_hz = number("reference_frequency_hz", std::numeric_limits<double>::min(),
                                 std::numeric_limits<double>::max(), "a frequency above 0");
    return source;
  }

 private:
  std::string_view field(std::string_view name) const { return fields_[columns_.place(name)]; }

  imager::DirectionCosines equatorial_position(const imager::SkyDirection& phase_centre) const {
    const std::string own = frame();
    const imager::SkyDirection direction{number("ra_deg", -360, 360, "-360 to 360") * degree,
                                         number("dec_deg", -90, 90, "-90 to 90") * degree,
                                         own.empty() ? phase_centre.frame : own};
    try {
      return imager::direction_cosines(ms_io::in_frame(direction, phase_centre.frame), phase_centre);
    } catch (const std::invalid_argument&) {
      fail(shown("ra_deg", "dec_deg") + ": beyond the horizon, expected a source within 90 degrees of the phase centre, " +
           sexagesimal(phase_centre));
    }
  }
  imager::DirectionCosines tangent_position() const {
    const imager::DirectionCosines position{number("l_arcsec") * arcsec, number("m_arcsec") * arcsec};
    if (!(std::hypot(position.l, position.m) < 1))
      fail(shown("l_arcsec", "m_arcsec") + ": beyond the horizon, expected l² + m² below 1, which is 206265 arcsec squared");
    return position;
  }

  const Columns& columns_;
  Fields fields_;
};

/// The text of a file without the byte order mark that some programs write.
std::string_view readable(std::string_view text) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) fail("the text is UTF-16, expected ASCII or UTF-8");
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return text;
}

using StokesSources = std::array<std::vector<Source>, 4>;

/// Calls visit(line, columns) for each line of values of a list, and names the file and line of what it throws.
template <typename Visit>
void visit_lines(const std::string& path, Polarised polarised, const Visit& visit) {
  const std::string list = read_file(path);
  int line_number = 0;
  try {
    std::optional<Columns> columns;
    for (std::string_view text = readable(list); !text.empty();) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const std::string_view line = trimmed(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
      ++line_number;
      if (line.empty() || line.starts_with('#')) continue;
      if (columns) {
        visit(Line(line, *columns), *columns);
      } else {
        columns.emplace(line, polarised);
      }
    }
    if (!columns) fail("the list ends before a line that names its columns, " + Columns::expected());
  } catch (const std::runtime_error& error) {
    fail(path + ", line " + std::to_string(std::max(line_number, 1)) + ": " + error.what());
  }
}

StokesSources read_list(const std::string& path, const imager::SkyDirection& phase_centre, Polarised polarised) {
  StokesSources sources;
  visit_lines(path, polarised, [&](const Line& line, const Columns& columns) {
    for (std::size_t k = 0; k < flux_names.size(); ++k)
      if (columns.has(flux_names[k])) sources[k].push_back(line.source(phase_centre, flux_names[k]));
  });
  return sources;
}

}  // namespace

std::vector<Source> read_component_list(const std::string& path, const imager::SkyDirection& phase_centre) {
  return read_list(path, phase_centre, Polarised::no)[0];
}

std::array<std::vector<Source>, 4> read_stokes_components(const std::string& path, const imager::SkyDirection& phase_centre) {
  return read_list(path, phase_centre, Polarised::yes);
}

bool lists_directions(const std::string& path) {
  std::istringstream lines(read_file(path));
  for (std::string line; std::getline(lines, line);) {
    if (trimmed(line).empty() || trimmed(line).starts_with('#')) continue;
    const std::vector<std::string_view> names = split_at_commas(line);
    // The first may have a byte order mark before it.
    return std::any_of(names.begin(), names.end(), [](std::string_view name) { return trimmed(name).ends_with("ra_deg"); });
  }
  return false;
}

std::string listed_frame(const std::string& path) {
  std::string frame;
  visit_lines(path, Polarised::yes, [&](const Line& line, const Columns&) {
    const std::string own = line.frame();
    if (!frame.empty() && own != frame) fail("frame is not that of the first source, expected one frame for all of the list");
    frame = own;
  });
  return frame;
}

}  // namespace misfit::tools
