#include "tools/sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include "tools/text.h"

namespace misfit::tools {
namespace {

using imager::Source;

constexpr double degree = M_PI / 180;
constexpr double arcsec = degree / 3600;

using Fields = std::vector<std::string_view>;

Fields split(std::string_view line) {
  Fields fields;
  for (std::size_t comma; (comma = line.find(',')) != std::string_view::npos; line.remove_prefix(comma + 1))
    fields.push_back(trimmed(line.substr(0, comma)));
  fields.push_back(trimmed(line));
  return fields;
}

double number(std::string_view text) {
  const std::optional<double> value = finite_number(text);
  if (!value) throw std::runtime_error("'" + std::string(text) + "', expected a finite number");
  return *value;
}

/// Where each quantity stands in a line.
struct Columns {
  bool equatorial = false;
  std::size_t x = 0;  ///< ra_deg or l_arcsec
  std::size_t y = 0;  ///< dec_deg or m_arcsec
  std::size_t flux = 0;
  std::size_t count = 0;
};

Columns columns_of(const Fields& names) {
  const auto place = [&](std::string_view name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  Columns columns;
  columns.equatorial = place("ra_deg") < names.size();
  columns.x = place(columns.equatorial ? "ra_deg" : "l_arcsec");
  columns.y = place(columns.equatorial ? "dec_deg" : "m_arcsec");
  columns.flux = place("flux_jy");
  columns.count = names.size();
  // Three names found in three columns: nothing is missing, double or unknown.
  if (columns.count != 3 || std::max({columns.x, columns.y, columns.flux}) >= columns.count)
    throw std::runtime_error("expected a header with the columns ra_deg,dec_deg,flux_jy or l_arcsec,m_arcsec,flux_jy");
  return columns;
}

Source source_of(const Fields& fields, const Columns& columns, const imager::SkyDirection& phase_centre) {
  if (fields.size() != columns.count)
    throw std::runtime_error(std::to_string(fields.size()) + " values, expected " + std::to_string(columns.count));
  const double x = number(fields[columns.x]), y = number(fields[columns.y]), flux_jy = number(fields[columns.flux]);
  if (columns.equatorial) {
    if (std::abs(y) > 90) throw std::runtime_error("declination " + std::to_string(y) + ", expected -90 to 90 degrees");
    return {imager::direction_cosines({x * degree, y * degree, phase_centre.frame}, phase_centre), flux_jy};
  }
  const Source source{{x * arcsec, y * arcsec}, flux_jy};
  if (std::hypot(source.position.l, source.position.m) >= 1) throw std::runtime_error("l² + m² is not below 1: not on the sky");
  return source;
}

struct CardEntry {
  int x, y;  ///< cells to the east and to the north
  int flux_jy;
};

constexpr std::array<CardEntry, 34> card{{
    {0, 0, 2},       {0, 15, 2},     {-120, 180, 2}, {150, -150, 2}, {300, 90, 2},    {-90, 300, 2},  {90, -90, 1},
    {-90, 90, 1},    {-90, -90, 1},  {180, 90, 1},   {180, 180, 1},  {180, -180, 1},  {-180, 180, 1}, {-180, -180, 1},
    {270, 0, 1},     {0, -270, 1},   {-270, 0, 1},   {0, 270, 1},    {0, 330, 1},     {330, 0, 1},    {0, -330, 1},
    {-330, 0, 1},    {270, 270, 1},  {270, -270, 1}, {-270, 270, 1}, {-270, -270, 1}, {390, 390, 3},  {390, -390, 3},
    {-390, -390, 3}, {-390, 390, 3}, {345, 0, 2},    {-345, 0, 2},   {0, -345, 2},    {0, 345, 2},
}};

}  // namespace

std::vector<Source> read_component_list(const std::string& path, const imager::SkyDirection& phase_centre) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read the component list " + path);
  std::vector<Source> sources;
  Columns columns;
  int line_number = 0;
  try {
    for (std::string line; std::getline(file, line);) {
      ++line_number;
      const std::string_view text = trimmed(line);
      if (text.empty() || text.starts_with('#')) continue;
      if (columns.count == 0)
        columns = columns_of(split(text));
      else
        sources.push_back(source_of(split(text), columns, phase_centre));
    }
    if (columns.count == 0) columns_of({});
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ", line " + std::to_string(line_number) + ": " + error.what());
  }
  if (file.bad()) throw std::runtime_error("cannot read the component list " + path + " to its end");
  return sources;
}

std::vector<Source> test_card(double cell_rad) {
  std::vector<Source> sources;
  for (const auto& [x, y, flux_jy] : card) sources.push_back({{x * cell_rad, y * cell_rad}, double(flux_jy)});
  return sources;
}

}  // namespace misfit::tools
