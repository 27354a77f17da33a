#pragma once

#include <optional>

#include "imager/data/spectral_axis.h"
#include "tools/formats/regions/keywords.h"

namespace misfit::tools::regions {

/// The `range` of CASA region text:
///     range=[3chan, 7chan]    range=[1.42GHz, 1.421GHz]    range=[-320km/s, -330km/s], restfreq=1.420405752GHz
/// two whole channels, counted from 0, the lower first; or, in either order since one falls where the other rises, two
/// frequencies or two velocities.
struct SpectralRange {
  enum class Kind { channels, frequencies, velocities };

  Kind kind = Kind::channels;
  double one = 0;    ///< a channel, Hz or m/s
  double other = 0;  ///< the same
};

/// The range of keywords; nothing where they have none. Throws std::runtime_error that says what was expected where it is
/// none, whatever the image, and where frame, veltype or restfreq, which go with it, are none that CASA knows.
std::optional<SpectralRange> spectral_range(const RegionKeywords& keywords);

/// The planes that `range` reaches into, all of them where there is none. `frame` must be the image's; REST, the source's
/// frame, is the image's only where the data are in it. Velocities are of `veltype` RADIO, c (1 − f/f_rest), the default,
/// OPTICAL or Z, c (f_rest/f − 1), or BETA, c (1 − (f/f_rest)²) / (1 + (f/f_rest)²), and relative to `restfreq`, or else to the
/// image's line. Throws std::runtime_error that says what was expected.
PlaneSpan planes_of_range(const RegionKeywords& keywords, const imager::SpectralAxis& axis);

}  // namespace misfit::tools::regions
