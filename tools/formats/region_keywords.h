#pragma once

#include <map>
#include <string>
#include <string_view>

#include "imager/spectral_axis.h"

namespace misfit::tools {

/// What stands behind a region of CASA region text, [name] value: "coord=J2000, range=[3chan, 7chan], label='a, b'".
using RegionKeywords = std::map<std::string, std::string>;

/// Commas in brackets and quotes part nothing; what is no name=value is left out.
RegionKeywords parse_region_keywords(std::string_view text);

/// Some planes of an image, from `first` to `last`; none where first > last.
struct PlaneSpan {
  int first = 0;
  int last = 0;

  bool holds(int plane) const { return plane >= first && plane <= last; }
};

/// The planes that `range` reaches into, all of them where there is none. It is two channels, which count from 0, frequencies
/// or velocities, in either order:
///     range=[3chan, 7chan]    range=[1.42GHz, 1.421GHz]    range=[-320km/s, -330km/s], restfreq=1.420405752GHz
/// `frame` must be the image's. Velocities are of `veltype` RADIO, c (1 − f/f_rest), as without it, or OPTICAL, c (f_rest/f −
/// 1), and relative to `restfreq`, or else to the image's line. Throws std::runtime_error or std::invalid_argument that says
/// what was expected.
PlaneSpan planes_of_range(const RegionKeywords& keywords, const imager::SpectralAxis& axis);

}  // namespace misfit::tools
