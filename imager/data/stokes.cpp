#include "imager/data/stokes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string_view>

namespace misfit::imager {
namespace {

constexpr std::array<const char*, 12> names = {"I", "Q", "U", "V", "RR", "RL", "LR", "LL", "XX", "XY", "YX", "YY"};
constexpr std::array<int, 12> fits_codes = {1, 2, 3, 4, -1, -3, -4, -2, -5, -7, -8, -6};

std::size_t index_of(Stokes stokes) {
  return static_cast<std::size_t>(stokes) - 1;
}

Stokes at_index(std::size_t index) {
  return static_cast<Stokes>(index + 1);
}

[[noreturn]] void refuse(const std::string& text, const std::string& expected) {
  throw std::invalid_argument("--stokes " + (text.empty() ? "''" : text) + ": expected " + expected);
}

/// The one that `text` begins with; two letters before one.
Stokes leading(std::string_view text, const std::string& whole) {
  for (std::size_t letters = 2; letters > 0; --letters)
    for (std::size_t i = 0; i < names.size(); ++i)
      if (text.substr(0, letters) == names[i]) return at_index(i);
  refuse(whole, "some of I Q U V RR RL LR LL XX XY YX YY, such as I, IQUV or XXYY, or pseudoI");
}

bool lie_evenly(const std::vector<Stokes>& list) {
  for (std::size_t i = 2; i < list.size(); ++i)
    if (fits_stokes_code(list[i]) - fits_stokes_code(list[i - 1]) != fits_stokes_code(list[1]) - fits_stokes_code(list[0]))
      return false;
  return true;
}

}  // namespace

std::string stokes_name(Stokes stokes) {
  return names[index_of(stokes)];
}

int fits_stokes_code(Stokes stokes) {
  return fits_codes[index_of(stokes)];
}

bool is_stokes_code(int casacore_code) {
  return casacore_code >= 1 && casacore_code <= static_cast<int>(names.size());
}

bool is_fits_stokes_code(int fits_code) {
  return std::find(fits_codes.begin(), fits_codes.end(), fits_code) != fits_codes.end();
}

Stokes stokes_of_fits_code(int fits_code) {
  if (!is_fits_stokes_code(fits_code))
    throw std::invalid_argument("STOKES " + std::to_string(fits_code) + ": expected 1 to 4 or -1 to -8");
  return at_index(static_cast<std::size_t>(std::find(fits_codes.begin(), fits_codes.end(), fits_code) - fits_codes.begin()));
}

std::optional<int> plane_of(const std::vector<Stokes>& list, Stokes wanted) {
  const auto found = std::find(list.begin(), list.end(), wanted);
  if (found == list.end()) return std::nullopt;
  return static_cast<int>(found - list.begin());
}

std::string stokes_names(const std::vector<Stokes>& list) {
  std::string text;
  for (const Stokes stokes : list) text += stokes_name(stokes);
  return text;
}

bool is_pseudo_i(const std::string& text) {
  constexpr std::string_view name = "pseudoi";
  return std::equal(text.begin(), text.end(), name.begin(), name.end(),
                    [](char letter, char small) { return letter == small || letter == small - 'a' + 'A'; });
}

std::vector<Stokes> parse_stokes(const std::string& text) {
  if (is_pseudo_i(text)) return {Stokes::I};
  std::vector<Stokes> list;
  for (std::string_view rest = text; !rest.empty();) {
    if (rest.front() == ',' || rest.front() == ' ') {
      rest.remove_prefix(1);
      continue;
    }
    const Stokes next = leading(rest, text);
    if (std::find(list.begin(), list.end(), next) != list.end()) refuse(text, stokes_name(next) + " once");
    list.push_back(next);
    rest.remove_prefix(stokes_name(next).size());
  }
  if (list.empty()) refuse(text, "some of I Q U V RR RL LR LL XX XY YX YY, such as I, IQUV or XXYY, or pseudoI");
  if (lie_evenly(list)) return list;
  std::sort(list.begin(), list.end());
  if (!lie_evenly(list))
    refuse(text, "such as lie evenly on the STOKES axis of a FITS file: one, two, IQU, QUV, IQUV, RRLL, XXYY, …");
  return list;
}

}  // namespace misfit::imager
