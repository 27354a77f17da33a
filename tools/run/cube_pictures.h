#pragma once

#include <optional>
#include <string>
#include <vector>

#include "imager/image_header.h"
#include "imager/noise.h"
#include "tools/drawing/sketch.h"
#include "tools/run/image_options.h"
#include "tools/run/run_report.h"
#include "tools/run_page/report_page.h"

namespace misfit::tools {

/// What a cube's planes leave to be drawn once they are gone: the one with the brightest pixel of the first Stokes parameter,
/// and its PSF.
class CubePictures {
 public:
  void look_at(int channel, const imager::Image& image, const imager::Image& psf, const imager::Peak& brightest);

  /// The index of that plane among `planes`; 0 where there was none.
  std::size_t shown_among(const std::vector<PlaneReport>& planes) const;
  /// Draws <imagename>.image.png, or .residual.png without CLEAN, and .psf.png, and adds them to `drawn`, or returns in a
  /// sentence why there are none.
  std::string draw(const ImageOptions& options, const imager::ImageHeader& header, const RunReport& report,
                   std::vector<PagePicture>& drawn) const;

 private:
  struct Plane {
    int channel = 0;
    Sketch image;
    Sketch psf;
    double brightest = 0;
  };
  std::optional<Plane> shown_;
};

/// The brightest pixel and the noise of each plane against frequency, as SVG; empty where gnuplot cannot draw it.
std::string spectrum_drawing(const RunReport& report);

}  // namespace misfit::tools
