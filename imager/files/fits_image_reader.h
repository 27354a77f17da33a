#pragma once

#include <memory>
#include <string>

#include "imager/files/image_reader.h"

namespace misfit::imager {

/// Opens the primary image of a FITS file whose pixels lie on the sky as read_sky_grid() says and `grids` wants, in any pixel
/// type, with planes along a FREQ or VRAD axis and a STOKES axis if there are any. Throws std::runtime_error that names the
/// path when it cannot be read, is cut short, lies on the sky in another way, or has other axes that are longer than 1.
std::unique_ptr<ImageReader> open_fits_image(const std::string& path, Grids grids = Grids::upright);

}  // namespace misfit::imager
