#pragma once

#include <string>
#include <string_view>

#include "imager/numerics/constants.h"
#include "ms_io/sexagesimal.h"

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

/// A sexagesimal angle, rad; see ms_io::sexagesimal_rad(). Refuses what is none.
double sexagesimal(std::string_view text, ms_io::Colons colons, const std::string& expected);

}  // namespace misfit::tools::regions
