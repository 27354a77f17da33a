#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "imager/data/stokes.h"

namespace misfit::tools::regions {

/// The keywords behind a region of CASA region text, [name] value: "coord=J2000, range=[3chan, 7chan], label='a, b'". Names are
/// in small letters, values without quotes.
using RegionKeywords = std::map<std::string, std::string>;

/// Keywords of a line, with commas or blanks between them; commas in brackets and quotes part nothing. Throws
/// std::runtime_error that says what was expected where one is none of CASA's, has no value, or stands there twice.
RegionKeywords parse_region_keywords(std::string_view text);

/// The value of a keyword; empty where there is none.
std::string value_of(const RegionKeywords& keywords, const std::string& name);

/// Throws std::runtime_error that shows a keyword with its value, and says what was expected in its place.
[[noreturn]] void refuse_value(const RegionKeywords& keywords, const std::string& name, const std::string& expected);

/// Some planes of an image, from `first` to `last`; none where first > last.
struct PlaneSpan {
  int first = 0;
  int last = 0;
  bool beyond = false;  ///< whether channels behind the image's last were named too

  bool empty() const { return first > last; }
  bool holds(int plane) const { return plane >= first && plane <= last; }
};

/// [Stokes parameter of the image], whether `corr` names it, such as corr=[I, Q] or corr=[XX]; all where there is none. A
/// Stokes parameter that the image lacks names no plane. Throws std::runtime_error that says what was expected where it is none
/// of CASA's.
std::vector<bool> stokes_of_corr(const RegionKeywords& keywords, const std::vector<imager::Stokes>& image);

/// The frame of `coord`, as ms_io::in_frame() calls it, or `image`'s where there is none. Throws std::runtime_error that lists
/// what is known.
std::string frame_of_coord(const RegionKeywords& keywords, const std::string& image);

}  // namespace misfit::tools::regions
