#pragma once

#include <string>
#include <string_view>

#include "imager/constants.h"

namespace misfit::tools::regions {

inline constexpr double degree = imager::pi / 180;  ///< rad

/// Throws std::runtime_error that shows `text`, shortened, and says what was expected in its place.
[[noreturn]] void refuse(std::string_view text, const std::string& expected);

/// `text` with small letters; formats of region files know no capitals.
std::string small_letters(std::string_view text);

/// Takes the letters, digits and underscores off the beginning of `text`, and the white space around them.
std::string_view take_word(std::string_view& text);

/// The finite number that `text` is; else refuses `whole`, in which it stands.
double number_of(std::string_view text, std::string_view whole, const std::string& expected);

/// What ends the first two parts of a sexagesimal angle: 12h30m49.4s, 12d23m28s, 12:23:28.0 or 12.23.28.0.
struct Sexagesimal {
  char first;
  char second;  ///< if it is m, an s ends the third
};
inline constexpr Sexagesimal hours_letters{'h', 'm'}, degrees_letters{'d', 'm'}, colons{':', ':'}, dots{'.', '.'};

/// Such an angle in units of its first part. Refuses what is none.
double parse_sexagesimal(std::string_view text, Sexagesimal form, const std::string& expected);

}  // namespace misfit::tools::regions
