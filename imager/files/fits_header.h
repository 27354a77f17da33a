#pragma once

#include "imager/files/fits_axes.h"
#include "imager/files/fits_file.h"
#include "imager/files/image_header.h"

namespace misfit::imager {

/// Writes `header` without its history, for an image with the axes RA---SIN, DEC--SIN, FREQ and STOKES.
void write_header(FitsFile& file, const ImageHeader& header);

void write_cards(FitsFile& file, const std::vector<HeaderCard>& cards);

/// Reads all that the header states but cards, history, and the place on the sky. Throws std::runtime_error as
/// read_spectral_axis() and read_stokes() do.
ImageHeader read_header(const FitsFile& file, const FitsPlanes& planes);

}  // namespace misfit::imager
