#pragma once

#include <memory>
#include <string>
#include <vector>

#include "imager/image_writer.h"

namespace misfit::tools {

/// What --outformat names: fits, casa or both.
const std::vector<std::string>& image_formats();

/// Begins the files of an image: `name`.fits, or the CASA image `name`, or both. One writer writes them all, and finish()
/// leaves all under their names. Throws what create_fits_image() and create_casa_image() throw.
std::unique_ptr<imager::ImageWriter> open_image_files(const std::string& name, const imager::ImageHeader& header,
                                                      imager::PixelFormat format, const std::string& outformat);

}  // namespace misfit::tools
