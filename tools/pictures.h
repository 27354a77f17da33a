#pragma once

#include <string>
#include <vector>

#include "imager/fits_image.h"

namespace misfit::tools {

/// A picture to draw: east is left and north up, axes are offsets from the phase centre, the colour bar states unit and
/// stretch. Pixels that are NaN have the colour of the background, white.
struct Picture {
  const imager::SkyImage* image = nullptr;
  std::string title;
  std::string path;  ///< of the PNG file; replaced when it exists
};

/// Draws all pictures with one run of gnuplot, found on PATH. Returns an empty string, or in one sentence why there are no
/// pictures (gnuplot is not installed, or failed). Files appear only when complete. Throws std::runtime_error that names the
/// folder of a picture when it cannot be written.
std::string draw_pictures(const std::vector<Picture>& pictures);

}  // namespace misfit::tools
