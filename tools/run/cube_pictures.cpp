#include "tools/run/cube_pictures.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "imager/data/stokes.h"
#include "tools/base/files.h"
#include "tools/base/numbers.h"
#include "tools/drawing/pictures.h"
#include "tools/formats/image_file.h"
#include "tools/run/image_files.h"
#include "tools/run_page/spectrum_figure.h"

namespace misfit::tools {
namespace {

/// Empty where gnuplot cannot draw it.
std::string spectrum_drawing(const RunReport& report) {
  Spectrum spectrum{.frame = report.cube ? report.cube->frame : "", .frequency_hz = {}, .brightest_jy = {}, .noise_jy = {}};
  for (const PlaneReport& plane : report.planes) {
    if (plane.sums.used == 0) continue;
    spectrum.frequency_hz.push_back(plane.frequency_hz);
    spectrum.brightest_jy.push_back(plane.stokes.front().brightest.value);
    spectrum.noise_jy.push_back(plane.stokes.front().histogram.noise_jy);
  }
  if (spectrum.frequency_hz.empty()) return "";
  try {
    return draw_svg(spectrum_figure(spectrum));
  } catch (const std::runtime_error&) {  // the pictures say why
    return "";
  }
}

}  // namespace

std::unique_ptr<imager::ImageReader> open_written(const ImageOptions& o, const std::string& kind) {
  return open_image_file(image_paths(o.imagename + "." + kind, o.outformat).front());
}

std::size_t brightest_plane(const std::vector<PlaneReport>& planes) {
  const auto brightness = [](const PlaneReport& plane) {
    return plane.sums.used == 0 ? -1 : std::abs(plane.stokes.front().brightest.value);
  };
  const auto found = std::max_element(
      planes.begin(), planes.end(), [&](const PlaneReport& a, const PlaneReport& b) { return brightness(a) < brightness(b); });
  return static_cast<std::size_t>(found - planes.begin());
}

void count_pixels(const ImageOptions& o, PlaneReport& plane, int threads) {
  if (plane.sums.used == 0) return;
  const auto file = open_written(o, "residual");
  for (std::size_t s = 0; s < plane.stokes.size(); ++s) {
    PixelHistogram& histogram = plane.stokes[s].histogram;
    histogram = pixel_histogram(file->read({plane.channel, static_cast<int>(s)}), histogram.noise_jy, threads);
  }
}

CubeDrawings draw_cube(const ImageOptions& o, const imager::ImageHeader& header, const RunReport& report) {
  const PlaneReport& plane = report.planes[report.shown];
  const std::string of =
      ", plane " + std::to_string(plane.channel) + " at " + frequency_text(plane.frequency_hz, 7) + " " + header.spectral.frame;
  imager::SkyImage about;
  about.geometry = header.geometry;
  about.observation = header.observation;
  about.observation.frequency_hz = plane.frequency_hz;
  if (plane.beams && plane.beams->restoring) {
    about.has_beam = true;
    about.beam = *plane.beams->restoring;
  }
  const bool cleaned = o.niter > 0 && plane.stokes.front().clean;
  const std::string kind = cleaned ? "image" : "residual";
  const imager::PlaneIndex at{plane.channel, 0};
  const imager::Image image = open_written(o, kind)->read(at), psf = open_written(o, "psf")->read(at);
  const std::string image_path = o.imagename + "." + kind + ".png", psf_path = o.imagename + ".psf.png";
  const std::string title = (cleaned ? "Restored image" : "Dirty image") + of;
  PictureDrawing drawing;
  drawing.add({{.image = &about, .title = title, .path = image_path, .pixels = &image},
               {.image = &about, .title = "PSF" + of, .path = psf_path, .pixels = &psf}});
  CubeDrawings drawn;
  drawn.spectrum = spectrum_drawing(report);
  drawn.failure = drawing.finish();
  if (drawn.failure.empty()) drawn.pictures = {{title, read_file(image_path)}, {"PSF" + of, read_file(psf_path)}};
  return drawn;
}

}  // namespace misfit::tools
