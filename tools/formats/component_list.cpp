#include "tools/formats/component_list.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "tools/base/files.h"
#include "tools/base/numbers.h"
#include "tools/base/text.h"

namespace misfit::tools {
namespace {

using imager::Source;

constexpr double degree = M_PI / 180;
constexpr double arcsec = degree / 3600;
constexpr std::array<std::string_view, 4> flux_names{"flux_jy", "flux_q_jy", "flux_u_jy", "flux_v_jy"};

/// Which fluxes a list may have.
enum class Polarised { no, yes };

[[noreturn]] void fail(const std::string& message) {
  throw std::runtime_error(message);
}

/// What a file holds, so that it fits in a line of a message.
std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, longest)) result += static_cast<unsigned char>(c) < ' ' || c == '\x7f' ? '?' : c;
  return result + (text.size() > longest ? "…'" : "'");
}

using Fields = std::vector<std::string_view>;

/// Where each quantity stands in a line.
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
    if (has("spectral_index") != has("reference_frequency_hz"))
      fail("no column " + quoted(has("spectral_index") ? "reference_frequency_hz" : "spectral_index") +
           ", expected both or neither of spectral_index and reference_frequency_hz");
  }

  static std::string expected() {
    return "expected ra_deg,dec_deg,flux_jy or l_arcsec,m_arcsec,flux_jy, and scale_arcsec if sources are extended, "
           "spectral_index,reference_frequency_hz if fluxes depend on frequency";
  }
  std::size_t count() const { return names_.size(); }
  bool has(std::string_view name) const { return place(name) < names_.size(); }
  std::size_t place(std::string_view name) const {
    return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  }

  bool equatorial = false;

 private:
  static constexpr std::array<std::string_view, 8> known{"ra_deg",  "dec_deg",      "l_arcsec",       "m_arcsec",
                                                         "flux_jy", "scale_arcsec", "spectral_index", "reference_frequency_hz"};

  Fields names_;
};

/// A line of values.
class Line {
 public:
  Line(std::string_view text, const Columns& columns) : columns_(columns), fields_(split_at_commas(text)) {
    if (fields_.size() != columns.count())
      fail(std::to_string(fields_.size()) + " values, expected " + std::to_string(columns.count()));
  }

  /// Throws unless it is a finite number from `least` to `most`.
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
    const imager::SkyDirection direction{number("ra_deg", -360, 360, "-360 to 360") * degree,
                                         number("dec_deg", -90, 90, "-90 to 90") * degree, phase_centre.frame};
    try {
      return imager::direction_cosines(direction, phase_centre);
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

StokesSources sources_of(std::string_view text, const imager::SkyDirection& phase_centre, Polarised polarised,
                         int& line_number) {
  StokesSources sources;
  std::optional<Columns> columns;
  for (text = readable(text); !text.empty();) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    ++line_number;
    if (line.empty() || line.starts_with('#')) continue;
    if (!columns) {
      columns.emplace(line, polarised);
      continue;
    }
    const Line values(line, *columns);
    for (std::size_t k = 0; k < flux_names.size(); ++k)
      if (columns->has(flux_names[k])) sources[k].push_back(values.source(phase_centre, flux_names[k]));
  }
  if (!columns) fail("the list ends before a line that names its columns, " + Columns::expected());
  return sources;
}

StokesSources read_list(const std::string& path, const imager::SkyDirection& phase_centre, Polarised polarised) {
  const std::string text = read_file(path);
  int line_number = 0;
  try {
    return sources_of(text, phase_centre, polarised, line_number);
  } catch (const std::runtime_error& error) {
    fail(path + ", line " + std::to_string(std::max(line_number, 1)) + ": " + error.what());
  }
}

/// The shortest text that reads as `value`.
void append_number(double value, std::string& text) {
  std::array<char, 32> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), end);
}

std::string flux_column(imager::Stokes stokes) {
  if (stokes == imager::Stokes::I) return "flux_jy";
  std::string name = "flux_" + stokes_name(stokes) + "_jy";
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return name;
}

/// Those of the lists, after that of I.
std::vector<imager::Stokes> flux_columns(const std::vector<SourcesOf>& lists) {
  std::vector<imager::Stokes> columns{imager::Stokes::I};
  for (const SourcesOf& list : lists)
    if (list.stokes != imager::Stokes::I) columns.push_back(list.stokes);
  return columns;
}

/// The position's two values, see write_stokes_components().
std::vector<double> position_values(const imager::DirectionCosines& at,
                                    const std::optional<imager::SkyDirection>& phase_centre) {
  if (!phase_centre) return {at.l / arcsec, at.m / arcsec};
  const imager::SkyDirection direction = imager::sky_direction(at, *phase_centre);
  const double ra_deg = direction.ra_rad / degree;
  return {ra_deg < 360 ? ra_deg : 0, direction.dec_rad / degree};
}

/// With `fluxes`, one of which is the source's own, and 0 in the other columns.
void append_line(const Source& source, const std::vector<double>& fluxes,
                 const std::optional<imager::SkyDirection>& phase_centre, std::string& text) {
  const auto& [l, m] = source.position;
  if (!(std::hypot(l, m) < 1))
    fail("l " + significant(l, 9) + ", m " + significant(m, 9) + ": beyond the horizon, expected l² + m² below 1");
  if (!std::isfinite(source.flux_jy) || !std::isfinite(source.fwhm_rad) || source.fwhm_rad < 0)
    fail("flux " + std::to_string(source.flux_jy) + " Jy and width " + std::to_string(source.fwhm_rad) +
         " rad, expected finite numbers, and a width of 0 or more");
  std::vector<double> values = position_values(source.position, phase_centre);
  values.insert(values.end(), fluxes.begin(), fluxes.end());
  values.push_back(source.fwhm_rad / arcsec);
  for (const double value : values) {
    append_number(value, text);
    text += ',';
  }
  text.back() = '\n';
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

void write_component_list(const std::string& path, const std::vector<Source>& sources,
                          const imager::SkyDirection& phase_centre) {
  write_stokes_components(path, {{imager::Stokes::I, sources}}, phase_centre);
}

void write_stokes_components(const std::string& path, const std::vector<SourcesOf>& lists,
                             const std::optional<imager::SkyDirection>& phase_centre) {
  const std::vector<imager::Stokes> columns = flux_columns(lists);
  std::string text = phase_centre ? "ra_deg,dec_deg" : "l_arcsec,m_arcsec";
  for (const imager::Stokes column : columns) text += "," + flux_column(column);
  text += ",scale_arcsec\n";
  int line = 1;
  for (const SourcesOf& list : lists)
    for (const Source& source : list.sources) try {
        ++line;
        std::vector<double> fluxes;
        for (const imager::Stokes column : columns) fluxes.push_back(column == list.stokes ? source.flux_jy : 0);
        append_line(source, fluxes, phase_centre, text);
      } catch (const std::runtime_error& error) {
        fail(path + ", line " + std::to_string(line) + ": " + error.what());
      }
  write_file(path, text);
}

}  // namespace misfit::tools
