#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "imager/files/image_header.h"
#include "imager/files/image_reader.h"
#include "tools/drawing/pictures.h"
#include "tools/run/channel_run.h"
#include "tools/run/image_options.h"
#include "tools/run/run_report.h"
#include "tools/run/taylor_stage.h"
#include "tools/run_page/report_page.h"

namespace misfit::tools {

/// One of a run's images, in the first of its formats.
std::unique_ptr<imager::ImageReader> open_written(const ImageOptions& options, const std::string& kind);

/// The pictures of a run, <imagename>.<name>.png, drawn while the caller does other things. Images are looked at until
/// functions return. All images of a whole band are drawn as they are made, each Stokes parameter by itself; of a cube, the
/// channel that the report shows is drawn once its images have been written. Stage timed: "draw pictures".
class RunPictures {
 public:
  /// The arguments are kept by reference.
  RunPictures(const ImageOptions& options, const imager::ImageHeader& header, imager::StageTimes& times)
      : o_(options), header_(header), times_(times) {}

  /// Draws what is there before CLEAN: uv coverage, PSF, dirty images. Where masks are made meanwhile the dirty image is drawn
  /// with the others.
  void draw_dirty(ChannelRun& run);
  /// Draws CLEAN's images of a Stokes parameter, the last made first.
  void draw(std::size_t stokes, const imager::CleanResult& cleaned, const RestoredTerms& restored);
  /// Draws a channel of a cube: its restored image, or the dirty one without CLEAN, and the PSF.
  void draw_channel(const ChannelReport& channel);

  /// Adds the pictures to `drawn`, the last first, or returns in a sentence why there are none.
  std::string finish(std::vector<PagePicture>& drawn);

 private:
  /// One picture to draw.
  struct Shown {
    std::string name;  ///< the middle of its file's name
    std::string title;
    std::string unit = "Jy/beam";
    Shades shades = Shades::brightness;
    const imager::Image* image = nullptr;
    const Sketch* sketch = nullptr;       ///< in place of an image that is gone
    const imager::Image* mask = nullptr;  ///< outlined
  };

  /// The picture of one Stokes parameter, which name and title state where there are several.
  Shown of_stokes(std::size_t stokes, Shown shown) const;
  void add(const std::vector<Shown>& shown);

  const ImageOptions& o_;
  const imager::ImageHeader& header_;
  imager::StageTimes& times_;
  imager::SkyImage about_;  ///< the image of the pictures, without its pixels
  PictureDrawing drawing_;
  std::vector<std::pair<std::string, std::string>> titles_and_paths_;
  std::vector<Sketch>
      dirty_;  ///< [Stokes], what is left of the dirty images when CLEAN is over, where masks were not known before
};

/// The histogram of a channel's residuals as an SVG element; empty where gnuplot cannot draw it.
std::string histogram_drawing(const ChannelReport& channel);
/// The brightest pixel and the noise of each channel against frequency, as histogram_drawing() does.
std::string spectrum_drawing(const RunReport& report);

}  // namespace misfit::tools
