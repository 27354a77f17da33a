#include "tools/base/quantity.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

namespace misfit::tools {
namespace {

using Units = std::vector<std::pair<std::string, double>>;

double parse(const std::string& text, const std::string& what, const std::string& such_as, const Units& units) {
  const auto fail = [&] {
    std::string names;  // the first name of each size
    double size_before = 0;
    for (const auto& [name, size] : units) {
      if (name.empty()) continue;
      if (size != size_before) names += (names.empty() ? "" : ", ") + name;
      size_before = size;
    }
    throw std::invalid_argument("'" + text + "' is no " + what + "; expected a number with a unit of " + names + ", such as " +
                                such_as);
  };
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = text.data() + text.size();
  double number = 0;
  const auto [rest, error] = std::from_chars(begin, end, number);
  if (text.starts_with("+-") || error != std::errc() || !std::isfinite(number)) fail();
  std::string unit(rest, end);
  unit.erase(0, unit.find_first_not_of(' '));
  for (const auto& [name, size] : units)
    if (name == unit && std::isfinite(number * size)) return number * size;
  fail();
  return 0;
}

}  // namespace

double parse_angle_rad(const std::string& text) {
  constexpr double degree = std::numbers::pi / 180;
  return parse(text, "angle", "0.2arcsec",
               {{"", degree / 3600},
                {"deg", degree},
                {"arcmin", degree / 60},
                {"amin", degree / 60},
                {"arcsec", degree / 3600},
                {"asec", degree / 3600},
                {"mas", degree / 3.6e6},
                {"marcsec", degree / 3.6e6},
                {"masec", degree / 3.6e6},
                {"uas", degree / 3.6e9},
                {"uarcsec", degree / 3.6e9},
                {"uasec", degree / 3.6e9},
                {"rad", 1}});
}

double parse_flux_jy(const std::string& text) {
  return parse(text, "flux density", "1mJy", {{"", 1}, {"Jy", 1}, {"mJy", 1e-3}, {"uJy", 1e-6}});
}

double parse_frequency_hz(const std::string& text) {
  return parse(text, "frequency", "1.4GHz", {{"", 1}, {"Hz", 1}, {"kHz", 1e3}, {"MHz", 1e6}, {"GHz", 1e9}});
}

double parse_velocity_m_s(const std::string& text) {
  return parse(text, "velocity", "20km/s", {{"m/s", 1}, {"km/s", 1e3}});
}

double parse_uv_distance_lambda(const std::string& text) {
  return parse(text, "distance in the uv plane", "3klambda", {{"", 1}, {"lambda", 1}, {"klambda", 1e3}, {"Mlambda", 1e6}});
}

bool has_unit(const std::string& text) {
  return !text.empty() && std::isalpha(static_cast<unsigned char>(text.back())) != 0;
}

}  // namespace misfit::tools
