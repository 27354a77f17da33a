#pragma once

#include "imager/fits_axes.h"
#include "imager/fits_file.h"
#include "imager/image_header.h"

namespace misfit::imager {

/// Writes what `header` holds but for its history, for an image with the axes RA---SIN, DEC--SIN, FREQ and STOKES.
void write_header(FitsFile& file, const ImageHeader& header);

void write_cards(FitsFile& file, const std::vector<HeaderCard>& cards);

/// What the file says but for its cards and history. Throws std::runtime_error where it states another projection than SIN,
/// pixels that are not square, or what read_spectral_axis() and read_stokes() refuse.
ImageHeader read_header(const FitsFile& file, const FitsPlanes& planes);

}  // namespace misfit::imager
