#pragma once

#include <memory>
#include <string>
#include <vector>

#include "imager/data/image.h"
#include "imager/files/image_header.h"
#include "tools/mosaic/pointing_image.h"

namespace misfit::tools {

/// The primary beam with which an image was seen.
class PointingBeam {
 public:
  virtual ~PointingBeam() = default;
  /// The beam at the image's channel in the pixels of the mosaic; NaN where it is not known, or below LinearMosaic::least_beam.
  /// Throws std::runtime_error that names the image.
  virtual imager::Image on(const imager::ImageHeader& mosaic, int channel, int threads) const = 0;
  /// Where it comes from, in words.
  virtual std::string origin() const = 0;
  /// True if it lies about the image's reference direction, wherever antennas pointed.
  virtual bool is_about_reference() const = 0;
  /// Sentences on what may be wrong with the beam.
  virtual std::vector<std::string> doubts() const { return {}; }
};

/// The beam `asked`, as --beam names it; where that is empty, the image .pb beside the image, which holds the weights, dishes
/// and turns with which the image was made; and where there is none, the beam of the telescope in the header, around the
/// header's reference direction, at its frequencies, each of which counts alike. The mean over position angles of beams that
/// are not round, with a doubt. Keeps `image` by reference. Throws std::runtime_error that names the image and what was
/// expected where none is to be had.
std::unique_ptr<PointingBeam> pointing_beam(const PointingImage& image, const std::string& asked);

}  // namespace misfit::tools
