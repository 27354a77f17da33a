#include "tools/base/numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

namespace misfit::tools {
namespace {

template <typename... Values>
std::string print(const char* format, Values... values) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

/// Splits `units` of 1/60 of 1/60 into whole ones, sixtieths and the rest, rounded to `decimals` before it is split.
struct Sexagesimal {
  int whole;
  int minutes;
  double seconds;
};
Sexagesimal split(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  const auto ticks = std::llround(value * 3600 * scale);
  const auto per_minute = static_cast<long long>(60 * scale);
  return {static_cast<int>(ticks / per_minute / 60), static_cast<int>(ticks / per_minute % 60),
          static_cast<double>(ticks % per_minute) / scale};
}

}  // namespace

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return "not finite";
  std::string text = print("%.*e", digits - 1, std::abs(value));
  const int exponent = std::stoi(text.substr(text.find('e') + 1));
  const bool plain = value == 0 || (exponent >= -4 && exponent < 6);
  if (plain) text = print("%.*f", std::max(0, digits - 1 - exponent), std::stod(text));
  const std::string power = plain ? "" : text.substr(text.find('e'));
  text.resize(text.size() - power.size());
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return (value < 0 ? "−" : "") + text + power;
}

std::string power_of_ten(double value, int digits, const std::function<std::string(int exponent)>& power) {
  const double magnitude = std::abs(value);
  if (value == 0 || !std::isfinite(value) || (magnitude >= 0.01 && magnitude < 1000)) return significant(value, digits);
  const std::string text = print("%.*e", digits - 1, magnitude);
  const auto split = text.find('e');
  const std::string factor = significant(std::stod(text.substr(0, split)), digits);
  const std::string raised = power(std::stoi(text.substr(split + 1)));
  return (value < 0 ? "−" : "") + (factor == "1" ? raised : factor + " × " + raised);
}

std::string all_digits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

std::string power_of_ten(double value, int digits) {
  std::string text = power_of_ten(value, digits, [](int exponent) {
    constexpr std::array<const char*, 10> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string power = "10";
    for (const char c : std::to_string(exponent)) power += c == '-' ? "⁻" : raised[static_cast<std::size_t>(c - '0')];
    return power;
  });
  const auto times = text.find(" × ");
  if (times != std::string::npos) text.replace(times, std::string(" × ").size(), "\u00a0×\u00a0");
  return text;
}

std::string grouped(long long count) {
  std::string text = std::to_string(count);
  for (int at = static_cast<int>(text.size()) - 3; at > (count < 0 ? 1 : 0); at -= 3)
    text.insert(static_cast<std::size_t>(at), "\u2009");
  return text;
}

std::string in_runs(std::vector<int> numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::vector<std::string> runs;
  for (std::size_t i = 0, next; i < numbers.size(); i = next) {
    for (next = i + 1; next < numbers.size() && numbers[next] == numbers[next - 1] + 1;) ++next;
    const std::string first = std::to_string(numbers[i]);
    if (next - i == 2) next = i + 1;  // two are no run
    runs.push_back(next - i == 1 ? first : first + " to " + std::to_string(numbers[next - 1]));
  }
  std::string text;
  for (std::size_t i = 0; i < runs.size(); ++i) text += (i == 0 ? "" : i + 1 == runs.size() ? " and " : ", ") + runs[i];
  return text;
}

std::string duration(double seconds) {
  if (seconds < 0.9995) return print("%.0f ms", seconds * 1e3);
  if (seconds < 99.95) return significant(seconds, 3) + " s";
  const auto whole = std::llround(seconds);
  if (whole < 3600) return print("%lld min %02lld s", whole / 60, whole % 60);
  return print("%lld h %02lld min", whole / 3600, whole % 3600 / 60);
}

ScaledUnit scaled_unit(double value, const std::string& base) {
  constexpr std::array<std::pair<double, const char*>, 5> prefixes{
      {{1e3, "k"}, {1, ""}, {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}}};
  const double magnitude = std::abs(value);
  if (!(magnitude > 0)) return {1, base};
  for (const auto& [size, prefix] : prefixes) {
    if (magnitude >= 0.9995 * size) return {size, prefix + base};
  }
  return {prefixes.back().first, prefixes.back().second + base};
}

ScaledUnit angle_unit(double angle_rad) {
  constexpr double degree = std::numbers::pi / 180;
  if (angle_rad >= 3 * degree) return {degree, "deg"};
  if (angle_rad >= 5 * degree / 60) return {degree / 60, "arcmin"};
  if (angle_rad >= 0.3 * degree / 3600) return {degree / 3600, "arcsec"};
  return {degree / 3.6e6, "mas"};
}

ScaledUnit uv_unit(double lambda) {
  constexpr std::array<std::pair<double, const char*>, 3> units{{{1e9, "Gλ"}, {1e6, "Mλ"}, {1e3, "kλ"}}};
  for (const auto& [size, name] : units)
    if (lambda >= size) return {size, name};
  return {1, "λ"};
}

std::string with_prefix(double value, const std::string& base, int digits) {
  const ScaledUnit unit = scaled_unit(value, base);
  return significant(value / unit.size, digits) + " " + unit.name;
}

std::string angle_text(double angle_rad, int digits) {
  const ScaledUnit unit = angle_unit(std::abs(angle_rad));
  return significant(angle_rad / unit.size, digits) + " " + unit.name;
}

std::string frequency_text(double hz, int digits) {
  for (const auto& [size, name] : {std::pair{1e9, " GHz"}, {1e6, " MHz"}, {1e3, " kHz"}})
    if (std::abs(hz) >= size) return significant(hz / size, digits) + name;
  return significant(hz, digits) + " Hz";
}

std::string sexagesimal(const imager::SkyDirection& direction) {
  constexpr double degree = std::numbers::pi / 180;
  const double turn = std::fmod(direction.ra_rad / degree / 15, 24.0);
  const Sexagesimal ra = split(turn < 0 ? turn + 24 : turn, 3);
  const Sexagesimal dec = split(std::abs(direction.dec_rad) / degree, 2);
  return print("%02dh %02dm %06.3fs  ", ra.whole % 24, ra.minutes, ra.seconds) + (direction.dec_rad < 0 ? "−" : "+") +
         print("%02d° %02d′ %05.2f″", dec.whole, dec.minutes, dec.seconds);
}

}  // namespace misfit::tools
