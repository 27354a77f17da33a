#include "tools/html.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string_view>

#include "tools/numbers.h"

namespace misfit::tools {

std::string html_escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  result.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = at; k < at + 3; ++k)
      group = group << 8 | (k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0U);
    for (std::uint32_t k = 0; k < 4; ++k) result += at + k <= bytes.size() ? alphabet[group >> (18 - 6 * k) & 63U] : '=';
  }
  return result;
}

std::string html_power(double value, int digits) {
  const double magnitude = std::abs(value);
  if (value == 0 || !std::isfinite(value) || (magnitude >= 0.01 && magnitude < 1000)) return significant(value, digits);
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*e", digits - 1, magnitude);
  const std::string_view shown(text.data());
  const auto split = shown.find('e');
  const int exponent = std::stoi(std::string(shown.substr(split + 1)));
  std::string factor(shown.substr(0, split));
  if (factor.find('.') != std::string::npos) factor.resize(factor.find_last_not_of(".0") + 1);
  const std::string power = "10<sup>" + significant(exponent, 3) + "</sup>";
  return (value < 0 ? "−" : "") + (factor == "1" ? power : factor + " × " + power);
}

}  // namespace misfit::tools
