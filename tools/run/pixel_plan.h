#pragma once

#include <string>

#include "imager/data/extent.h"
#include "imager/data/geometry.h"
#include "imager/plan/plan.h"
#include "ms_io/measurement_set.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

// The pixels of an image, beside the sharpest beam and the widest field that its data can have.

/// The pixels and, where any baseline is known, the beam of the longest, B in wavelengths, whose FWHM is about 1/B rad, with
/// the cells of which 3 to 5 lie across it.
imager::Decision pixels_decision(const ImageOptions& options, const imager::ImageGeometry& geometry, double longest_lambda);

/// --cell as it was given, which is in arcsec where it has no unit.
std::string cell_words(const ImageOptions& options);

/// The width and height of the image and, where the beams of antennas of the first set are known, their FWHM at the middle of
/// the band, from the narrowest to the widest.
imager::Decision field_decision(const ImageOptions& options, const imager::ImageGeometry& geometry,
                                const ms_io::MeasurementSet& set);

/// True if samples may lie beyond 1/(2 cell).
bool leaves_grid(const imager::UvwReach& reach, const imager::ImageGeometry& geometry);

/// "a cell of 0.4442mas would keep them"
std::string keeping_cell_words(const imager::UvwReach& reach);

/// A warning, before samples are counted, that some may lie beyond 1/(2 cell).
std::string outside_grid_forecast(const imager::UvwReach& reach);

/// A warning that the pixel size cannot represent so many samples, with the pixel size that could.
std::string outside_grid_warning(std::uint64_t samples, const imager::UvwReach& reach);

}  // namespace misfit::tools
