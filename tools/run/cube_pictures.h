#pragma once

#include <memory>
#include <string>
#include <vector>

#include "imager/files/image_header.h"
#include "imager/files/image_reader.h"
#include "tools/run/image_options.h"
#include "tools/run/run_report.h"
#include "tools/run_page/report_page.h"

namespace misfit::tools {

/// One of a run's images, in the first of its formats.
std::unique_ptr<imager::ImageReader> open_written(const ImageOptions& options, const std::string& kind);

/// The index among `planes` of the one with the brightest pixel of the first Stokes parameter; 0 where none has samples.
std::size_t brightest_plane(const std::vector<PlaneReport>& planes);

/// Makes the histograms of a plane's residuals, of images that have been written.
void count_pixels(const ImageOptions& options, PlaneReport& plane, int threads);

/// What is drawn of a cube.
struct CubeDrawings {
  std::vector<PagePicture> pictures;
  std::string spectrum;  ///< SVG: the brightest pixel and the noise of each plane against frequency; may be empty
  std::string failure;   ///< why there are none, in a sentence; empty where there are
};

/// Draws the plane that `report` shows, of images that have been written: <imagename>.image.png, or .residual.png without
/// CLEAN, and .psf.png.
CubeDrawings draw_cube(const ImageOptions& options, const imager::ImageHeader& header, const RunReport& report);

}  // namespace misfit::tools
