#pragma once

#include <memory>
#include <string>
#include <vector>

#include "imager/files/fits_image.h"
#include "imager/streaming/uv_coverage.h"
#include "tools/drawing/picture_layout.h"
#include "tools/drawing/sketch.h"

namespace misfit::tools {

/// A picture to draw: east is left and north up, axes are offsets from the phase centre, which the title names; the colour bar
/// states unit and stretch; the beam lies to scale in the lower left corner, a scale bar in the lower right one. Pixels that
/// are NaN have the colour of the background, white.
struct Picture {
  const imager::SkyImage* image = nullptr;
  std::string title;
  std::string path;  ///< of the PNG file; replaced when it exists
  Shades shades = Shades::brightness;
  const imager::Image* pixels = nullptr;  ///< shown in place of the image's own
  const Sketch* sketch = nullptr;         ///< of the image, of side picture_side, when its pixels are gone
  const imager::Image* mask = nullptr;    ///< of the same pixels; what it allows is outlined in green
};

/// Draws pictures with gnuplot, found on PATH, each in a thread of its own while the caller does other things. No file appears
/// before finish().
class PictureDrawing {
 public:
  PictureDrawing();
  PictureDrawing(PictureDrawing&&) = default;
  ~PictureDrawing();

  /// Images, sketches and masks are looked at until it returns.
  void add(const std::vector<Picture>& pictures);
  /// Where samples lie, see write_uv_script(), as a PNG file at `path`.
  void add(const imager::UvCoverage& coverage, const std::string& path);

  /// Returns an empty string when all files are there and complete, or in one sentence why there are none (gnuplot is not
  /// installed, or failed; there is no folder for temporary files). Throws std::runtime_error that names the picture when it
  /// cannot be written.
  std::string finish();

 private:
  struct Sheet;
  std::vector<std::unique_ptr<Sheet>> sheets_;
};

std::string draw_pictures(const std::vector<Picture>& pictures);

}  // namespace misfit::tools
