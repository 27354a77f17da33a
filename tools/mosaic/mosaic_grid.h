#pragma once

#include <memory>
#include <vector>

#include "imager/beams/beam.h"
#include "imager/files/image_header.h"
#include "tools/mosaic/mosaic_options.h"
#include "tools/mosaic/pointing_beam.h"
#include "tools/mosaic/pointing_image.h"

namespace misfit::tools {

/// An image and its beam.
struct Pointing {
  std::unique_ptr<PointingImage> image;
  std::unique_ptr<PointingBeam> beam;
};

/// The header of the mosaic: that of the first image on the pixels that options ask for, or else around the middle of the
/// pointings, with the smallest of the images' cells, square and of an even number. It reaches, to a thousandth of its width,
/// as far as any beam is at the limit or above within its image. Throws std::runtime_error where pointings do not lie in one
/// hemisphere, where no beam reaches the limit within its image, or the mosaic would have more than 65536 pixels on a side.
imager::ImageHeader mosaic_header(const MosaicOptions& options, const std::vector<Pointing>& pointings, int threads);

/// By how much the position angle of a direction is larger about the north of the mosaic than about the north of the image's
/// reference direction, where both are seen.
double north_turn_rad(const PointingImage& image, const imager::ImageGeometry& mosaic);

}  // namespace misfit::tools
