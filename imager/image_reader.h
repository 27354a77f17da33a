#pragma once

#include <optional>

#include "imager/beam.h"
#include "imager/image.h"
#include "imager/image_header.h"
#include "imager/image_writer.h"

namespace misfit::imager {

/// An image in a file, of which one plane at a time need be in memory.
class ImageReader {
 public:
  virtual ~ImageReader() = default;
  /// What the file says, but for its cards and history.
  virtual const ImageHeader& header() const = 0;
  virtual std::optional<Beam> beam(const PlaneIndex& at) const = 0;
  /// The pixels of a plane; NaN where they have no value. Throws std::runtime_error that names the file where they cannot be
  /// read.
  virtual Image read(const PlaneIndex& at) const = 0;
};

}  // namespace misfit::imager
