#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "imager/spectral_axis.h"
#include "imager/stokes.h"

namespace misfit::tools::regions {

/// What stands behind a region of CASA region text, [name] value: "coord=J2000, range=[3chan, 7chan], label='a, b'". Names are
/// in small letters, values without quotes.
using RegionKeywords = std::map<std::string, std::string>;

/// Keywords of a line, with commas or blanks between them; commas in brackets and quotes part nothing. Throws
/// std::runtime_error that says what was expected where one is none of CASA's, has no value, or stands there twice.
RegionKeywords parse_region_keywords(std::string_view text);

/// Some planes of an image, from `first` to `last`; none where first > last.
struct PlaneSpan {
  int first = 0;
  int last = 0;

  bool empty() const { return first > last; }
  bool holds(int plane) const { return plane >= first && plane <= last; }
};

/// The planes that `range` reaches into, all of them where there is none. It is two channels, which count from 0, frequencies
/// or velocities, in either order:
///     range=[3chan, 7chan]    range=[1.42GHz, 1.421GHz]    range=[-320km/s, -330km/s], restfreq=1.420405752GHz
/// `frame` must be the image's. Velocities are of `veltype` RADIO, c (1 − f/f_rest), as without it, OPTICAL or Z, c (f_rest/f −
/// 1), or BETA, c (1 − (f/f_rest)²) / (1 + (f/f_rest)²), and relative to `restfreq`, or else to the image's line. Throws
/// std::runtime_error or std::invalid_argument that says what was expected.
PlaneSpan planes_of_range(const RegionKeywords& keywords, const imager::SpectralAxis& axis);

/// [Stokes parameter of the image], whether `corr` names it, such as corr=[I, Q] or corr=[XX]; all where there is none. One
/// that the image lacks is of no plane. Throws std::runtime_error that says what was expected where it is none of CASA's.
std::vector<bool> stokes_of_corr(const RegionKeywords& keywords, const std::vector<imager::Stokes>& image);

/// The frame of `coord`, as ms_io::in_frame() calls it, or `image`'s where there is none. Throws std::runtime_error that lists
/// what is known.
std::string frame_of_coord(const RegionKeywords& keywords, const std::string& image);

}  // namespace misfit::tools::regions
