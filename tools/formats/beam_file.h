#pragma once

#include <string>

#include "imager/beams/voltage_pattern.h"

namespace misfit::tools {

/// The kind of a beam's pixels.
enum class BeamPixels { power, voltage };

/// Reads a beam from a FITS image, or a cube whose third or fourth axis is the frequency: its pixels are a power or a voltage,
/// 1 on the axis, at the axes' reference pixel. The first two axes, not turned, are angles in deg, arcmin, arcsec or rad, or
/// direction cosines (SIN, or no unit): RA, X or L to the east where the zenith is north, or AZ to the west there, as azimuths
/// count, and DEC, Y, M or EL to the north; CDELT may be below 0. NaN is 0. An image of one plane states its frequency on an
/// axis or by RESTFRQ. Throws std::runtime_error that names the file, the card and what was expected.
imager::Pattern read_beam_file(const std::string& path, BeamPixels pixels);

}  // namespace misfit::tools
