#include "tools/formats/pointings.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "tools/base/files.h"
#include "tools/base/quantity.h"
#include "tools/base/text.h"

namespace misfit::tools {
namespace {

constexpr double degree = M_PI / 180;

struct Hexagon {
  int pointings = 0;
  double spacing_rad = 0;
};

/// The hexagon that `text` states; nothing where it is none.
std::optional<Hexagon> hexagon(const std::string& text) {
  constexpr double most = 10000;
  const std::vector<std::string_view> part = split_at_commas(text);
  if (part.size() != 3 || part[0] != "hex") return {};
  const std::optional<double> count = finite_number(part[1]);
  if (!count || *count < 1 || *count > most || *count != std::floor(*count)) return {};
  try {
    const Hexagon hexagon{static_cast<int>(*count), parse_angle_rad(std::string(part[2]))};
    if (hexagon.spacing_rad > 0) return hexagon;
  } catch (const std::invalid_argument&) {  // which could not name the option
  }
  return {};
}

/// The points of a lattice whose neighbours are 1 apart, nearest first; points at one distance are in order from the east
/// through the north.
std::vector<imager::DirectionCosines> lattice(int count) {
  std::vector<imager::DirectionCosines> points;
  const int rings = static_cast<int>(std::ceil(std::sqrt(count))) + 1;  // more than enough: ring r has 6 r
  for (int row = -rings; row <= rings; ++row)
    for (int column = -2 * rings; column <= 2 * rings; ++column)
      points.push_back({column + 0.5 * (row % 2 == 0 ? 0 : 1), row * std::sqrt(0.75)});
  const auto order = [](const imager::DirectionCosines& p) {
    constexpr double rounding = 1e-6;
    const double angle = std::atan2(p.m, p.l);
    return std::pair(std::round(std::hypot(p.l, p.m) / rounding), angle < 0 ? angle + 2 * M_PI : angle);
  };
  std::sort(points.begin(), points.end(), [&](const auto& a, const auto& b) { return order(a) < order(b); });
  points.resize(static_cast<std::size_t>(count));
  return points;
}

std::vector<imager::SkyDirection> listed(const std::string& path, const std::string& frame) {
  std::istringstream lines(read_file(path));
  std::vector<imager::SkyDirection> directions;
  bool named = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (trimmed(line).empty() || trimmed(line).starts_with('#')) continue;
    const auto fail = [&](const std::string& expected) {
      throw std::runtime_error(path + ", line " + std::to_string(number) + ": found '" + legible(trimmed(line)) +
                               "', expected " + expected);
    };
    const std::vector<std::string_view> values = split_at_commas(trimmed(line));
    if (!named) {
      if (values != std::vector<std::string_view>{"ra_deg", "dec_deg"}) fail("the names of the columns, ra_deg,dec_deg");
      named = true;
      continue;
    }
    const auto number_in = [&](std::size_t i, double most) {
      const std::optional<double> value = values.size() == 2 ? finite_number(values[i]) : std::nullopt;
      if (!value || std::abs(*value) > most) fail("a right ascension of -360 to 360 and a declination of -90 to 90 degrees");
      return *value * degree;
    };
    directions.push_back({number_in(0, 360), number_in(1, 90), frame});
  }
  if (directions.empty())
    throw std::runtime_error(path + " lists no pointing; expected a line ra_deg,dec_deg, and a line for each pointing");
  return directions;
}

}  // namespace

void check_pointings(const std::string& text) {
  if (hexagon(text) || std::filesystem::is_regular_file(text)) return;
  throw std::invalid_argument("--pointings '" + text +
                              "': expected hex,N,SPACING such as hex,7,10arcmin, with 1 to 10000 pointings; or a CSV file of "
                              "ra_deg,dec_deg, and there is no such file");
}

std::vector<imager::SkyDirection> pointings(const std::string& text, const imager::SkyDirection& centre) {
  const std::optional<Hexagon> of_hexagon = hexagon(text);
  if (!of_hexagon) return listed(text, centre.frame);
  std::vector<imager::SkyDirection> directions;
  for (const imager::DirectionCosines& point : lattice(of_hexagon->pointings)) {
    const imager::DirectionCosines at{point.l * of_hexagon->spacing_rad, point.m * of_hexagon->spacing_rad};
    if (imager::beyond_horizon(at))
      throw std::invalid_argument(
          "--pointings " + text +
          " reaches beyond 90 degrees from --ra and --dec; expected fewer pointings, or a smaller SPACING");
    directions.push_back(imager::sky_direction(at, centre));
  }
  return directions;
}

}  // namespace misfit::tools
