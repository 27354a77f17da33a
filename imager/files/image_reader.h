#pragma once

#include <optional>

#include "imager/beams/beam.h"
#include "imager/data/image.h"
#include "imager/files/image_header.h"
#include "imager/files/image_writer.h"
#include "imager/files/sky_grid.h"

namespace misfit::imager {

/// An image in a file, of which one plane at a time need be in memory.
class ImageReader {
 public:
  virtual ~ImageReader() = default;
  /// The file's header, without its cards and history.
  virtual const ImageHeader& header() const = 0;
  /// Where the pixels lie on the sky; none where the file does not say.
  virtual const std::optional<SkyGrid>& grid() const = 0;
  /// The beam of a plane. Throws std::runtime_error that names the file where its beams cannot be read, or are of other planes.
  virtual std::optional<Beam> beam(const PlaneIndex& at) const = 0;
  /// The pixels of a plane; NaN where they have no value. Throws std::runtime_error that names the file where they cannot be
  /// read.
  Image read(const PlaneIndex& at) const { return read_rows(at, 0, header().geometry.height); }
  /// Reads `count` rows of a plane, from row `first` on, as an image of that height.
  virtual Image read_rows(const PlaneIndex& at, int first, int count) const = 0;
};

}  // namespace misfit::imager
