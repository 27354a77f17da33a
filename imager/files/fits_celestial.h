#pragma once

#include <optional>

#include "imager/files/fits_axes.h"
#include "imager/files/fits_file.h"
#include "imager/files/sky_grid.h"

namespace misfit::imager {

/// Where the pixels along the first two axes of the primary image lie on the sky (Calabretta & Greisen 2002): right ascension
/// and declination in ICRS, FK5 of 2000 or FK4 of 1950, or galactic longitude and latitude, in the projections of SkyGrid or
/// NCP, with CDELT and PC or CROTA, or CD, and LONPOLE, in any unit of angle. None where the axes say nothing of the sky.
/// Throws std::runtime_error that names the keyword and what was expected, where they state anything else.
std::optional<SkyGrid> read_sky_grid(const FitsFile& file, const FitsSteps& steps);

}  // namespace misfit::imager
