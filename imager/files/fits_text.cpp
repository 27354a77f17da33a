#include "imager/files/fits_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

namespace misfit::imager {

std::string header_text(const std::string& text) {
  std::string kept;
  bool in_letter = false;
  for (const char c : text) {
    const bool continues = in_letter && (c & 0xc0) == 0x80;
    if (!continues) kept += c >= ' ' && c <= '~' ? c : '?';
    in_letter = continues || (c & 0xc0) == 0xc0;
  }
  return kept;
}

std::optional<double> header_number(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == 'D' || c == 'd'; }, 'E');
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc() && end == digits.data() + digits.size()) return value;
  return error == std::errc::result_out_of_range ? std::optional(HUGE_VAL) : std::nullopt;
}

std::string bare_header_value(std::string value) {
  if (value.size() < 2 || value.front() != '\'') return value;
  value = value.substr(1, value.rfind('\'') - 1);
  for (std::size_t at = value.find("''"); at != std::string::npos; at = value.find("''", at + 1)) value.erase(at, 1);
  return value.erase(value.find_last_not_of(' ') + 1);
}

bool same_header_value(const std::string& one, const std::string& other) {
  const std::optional<double> a = header_number(one), b = header_number(other);
  return one == other || (a && b && *a == *b);
}

std::string compression_of(const std::string& begin) {
  constexpr std::array<std::pair<std::string_view, const char*>, 5> kinds{
      {{"\x1f\x8b", "gzip: uncompress it first, with gunzip"},
       {"\x1f\x9d", "compress: uncompress it first, with gunzip"},
       {"BZh", "bzip2: uncompress it first, with bunzip2"},
       {"\xfd"
        "7zXZ",
        "xz: uncompress it first, with unxz"},
       {"PK\x03\x04", "zip: unpack it first, with unzip"}}};
  for (const auto& [magic, name] : kinds)
    if (begin.starts_with(magic)) return name;
  return "";
}

}  // namespace misfit::imager
