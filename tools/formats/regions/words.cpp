#include "tools/formats/regions/words.h"

#include <cctype>
#include <optional>
#include <stdexcept>

#include "tools/base/text.h"

namespace misfit::tools::regions {

void refuse(std::string_view text, const std::string& expected) {
  constexpr std::size_t most = 100;
  const std::string shown = text.size() > most ? std::string(text.substr(0, most)) + "…" : std::string(text);
  throw std::runtime_error("'" + shown + "', expected " + expected);
}

std::string small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  std::size_t end = 0;
  while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_')) ++end;
  const std::string_view word = text.substr(0, end);
  text = trimmed(text.substr(end));
  return word;
}

double number_of(std::string_view text, std::string_view whole, const std::string& expected) {
  const std::optional<double> value = finite_number(text);
  if (!value) refuse(whole, expected);
  return *value;
}

double parse_sexagesimal(std::string_view text, Sexagesimal form, const std::string& expected) {
  const bool negative = text.starts_with('-');
  std::string_view rest = text.substr(negative || text.starts_with('+') ? 1 : 0);
  const auto whole_part = [&](char end) {
    const std::size_t digits = rest.find_first_not_of("0123456789");
    if (digits == 0 || digits == std::string_view::npos || rest[digits] != end) refuse(text, expected);
    const double value = number_of(rest.substr(0, digits), text, expected);
    rest.remove_prefix(digits + 1);
    return value;
  };
  const double units = whole_part(form.first), minutes = whole_part(form.second);
  if (form.second == 'm') {
    if (!rest.ends_with('s')) refuse(text, expected);
    rest.remove_suffix(1);
  }
  if (rest.empty() || std::isdigit(static_cast<unsigned char>(rest.front())) == 0) refuse(text, expected);
  const double seconds = number_of(rest, text, expected);
  if (minutes >= 60 || seconds >= 60) refuse(text, expected);
  const double value = units + minutes / 60 + seconds / 3600;
  return negative ? -value : value;
}

}  // namespace misfit::tools::regions
