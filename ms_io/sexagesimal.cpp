#include "ms_io/sexagesimal.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "imager/numerics/constants.h"

namespace misfit::ms_io {
namespace {

constexpr std::string_view digits = "0123456789";

std::string_view without_sign(std::string_view text) {
  return text.substr(!text.empty() && (text.front() == '-' || text.front() == '+') ? 1 : 0);
}

/// The mark that ends the first part of a sexagesimal angle; 0 where `text`, which has no sign, does not begin like one.
char first_mark(std::string_view text) {
  const std::size_t end = text.find_first_not_of(digits);
  if (end == 0 || end >= text.size()) return 0;
  const std::string_view rest = text.substr(end + 1);
  switch (text[end]) {
    case ':':
      return ':';
    case 'h':
      return rest.empty() ? '\0' : 'h';
    case 'd':
      return rest.empty() || rest.front() == 'e' ? '\0' : 'd';
    case '.':
      return rest.find('.') == std::string_view::npos ? '\0' : '.';
    default:
      return 0;
  }
}

/// Takes digits, and with `fraction` a dot and others, off the beginning of `text`.
std::optional<double> take_number(std::string_view& text, bool fraction) {
  std::size_t end = std::min(text.find_first_not_of(digits), text.size());
  if (end == 0) return {};
  if (fraction && end < text.size() && text[end] == '.') end = std::min(text.find_first_not_of(digits, end + 1), text.size());
  double number = 0;
  std::from_chars(text.data(), text.data() + end, number);
  text.remove_prefix(end);
  return number;
}

bool take(std::string_view& text, char mark) {
  if (text.empty() || text.front() != mark) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

bool is_sexagesimal(std::string_view text) {
  return first_mark(without_sign(text)) != 0;
}

std::optional<double> sexagesimal_rad(std::string_view text, Colons colons, Parts parts) {
  std::string_view rest = without_sign(text);
  const char mark = first_mark(rest);
  if (mark == 0) return {};
  const bool letters = mark == 'h' || mark == 'd', some = parts == Parts::some,
             hours = mark == 'h' || (mark == ':' && colons == Colons::hours);
  const std::optional<double> units = take_number(rest, false);
  take(rest, mark);
  const std::optional<double> minutes = take_number(rest, false);
  if (!minutes) return {};
  const bool more = take(rest, letters ? 'm' : mark), ends = some && rest.empty() && mark != '.' && more == letters;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const double seconds = ends ? 0 : more ? take_number(rest, true).value_or(none) : none;
  if (letters && !ends && !take(rest, 's') && !some) return {};
  if (!(seconds <= 60) || !rest.empty() || *minutes >= 60) return {};
  const double value = *units + (60 * *minutes + seconds) / 3600;
  if (!(value <= (hours ? 24 : 360))) return {};
  const double angle_rad = value * (hours ? 15 : 1) * (imager::pi / 180);
  return text.front() == '-' ? -angle_rad : angle_rad;
}

}  // namespace misfit::ms_io
