#pragma once

#include <memory>
#include <string>

#include "imager/files/image_writer.h"

namespace misfit::imager {

/// Begins an image that finish() leaves at `path`, in place of what is there; until then it lies beside it. FITS axes:
/// RA---SIN, DEC--SIN, FREQ, STOKES, in this order. CRVAL is the phase centre and CRPIX the place where l = m = 0, be it
/// between pixels or outside the image. RESTFRQ is the rest frequency that was named, or else the middle of the band. BMAJ,
/// BMIN and BPA state the beam that all planes share; where they differ, or some have none, the table BEAMS states each (see
/// fits_beams.h). Throws std::invalid_argument where the header's Stokes parameters do not lie evenly on an axis, and
/// std::runtime_error that names the path and CFITSIO's reason.
std::unique_ptr<ImageWriter> create_fits_image(const ImageHeader& header, const std::string& path, PixelFormat format);

}  // namespace misfit::imager
