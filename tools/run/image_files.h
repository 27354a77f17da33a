#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "imager/files/image_writer.h"

namespace misfit::tools {

/// CFITSIO and casacore need not be thread-safe: a thread that reads or writes images while others may do so holds this.
std::mutex& image_files_mutex();

/// The values of --outformat: fits, casa and both.
const std::vector<std::string>& image_formats();

/// 64-bit where the accuracy asked for is below 1e-7, 32-bit otherwise.
imager::PixelFormat pixel_format(double accuracy);

/// The paths of an image's files: `name`.fits, or the CASA image `name`, or both.
std::vector<std::string> image_paths(const std::string& name, const std::string& outformat);

/// The path of an image, the newer one of both formats; nothing where there is none.
std::optional<std::string> newest_image(const std::string& name);

/// True if misfit wrote the image at this path: people keep masks and models of theirs under our names too.
bool is_own_image(const std::string& path);

/// Throws std::runtime_error where an image's path holds something that no image may replace; `option` gave the name.
void check_image_paths(const std::string& name, const std::string& outformat, const std::string& option = "--imagename");

/// Begins the files of an image at these paths. One writer writes them all, and finish() leaves all under their names. Throws
/// what create_fits_image() and create_casa_image() throw.
std::unique_ptr<imager::ImageWriter> open_image_files(const std::string& name, const imager::ImageHeader& header,
                                                      imager::PixelFormat format, const std::string& outformat);

}  // namespace misfit::tools
