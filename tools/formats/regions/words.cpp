#include "tools/formats/regions/words.h"

#include <cctype>
#include <optional>
#include <stdexcept>

#include "tools/base/text.h"

namespace misfit::tools::regions {

void refuse(std::string_view text, const std::string& expected) {
  constexpr std::size_t most = 100;
  const std::string shown = text.size() > most ? std::string(text.substr(0, most)) + "…" : std::string(text);
  throw std::runtime_error("found '" + shown + "', expected " + expected);
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

double sexagesimal(std::string_view text, ms_io::Colons colons, const std::string& expected) {
  const std::optional<double> angle_rad = ms_io::sexagesimal_rad(text, colons);
  if (!angle_rad) refuse(text, expected + ", with minutes below 60 and seconds of 60 at most");
  return *angle_rad;
}

}  // namespace misfit::tools::regions
