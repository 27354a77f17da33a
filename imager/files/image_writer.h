#pragma once

#include <optional>
#include <vector>

#include "imager/beams/beam.h"
#include "imager/data/image.h"
#include "imager/files/image_header.h"

namespace misfit::imager {

/// One plane of an image, counted from 0 along the spectral axis and the header's list of Stokes parameters.
struct PlaneIndex {
  int channel = 0;
  int stokes = 0;
};

/// How pixels are stored.
enum class PixelFormat { float32, float64 };

class ImageReader;

/// An image on its way into a file, plane by plane, so that no more than one need be in memory. The file has its final name
/// once finish() returns; a writer that is destroyed before leaves nothing.
class ImageWriter {
 public:
  virtual ~ImageWriter() = default;
  /// Writes a plane, in any order, each once. NaN marks a pixel without value, and planes never written have no values and no
  /// beam. Throws std::invalid_argument for a plane that the header does not have, or pixels of another shape;
  /// std::runtime_error that names the file where it cannot be written.
  virtual void write(const PlaneIndex& at, const Image& image, const std::optional<Beam>& beam) = 0;
  /// Files with masks also mask pixels that have no value in `other`, an image of the same size and channels, whose one Stokes
  /// parameter counts for all. To be called after the last plane.
  virtual void mask_like(const ImageReader& /*other*/) {}
  /// Adds cards to the header's, for numbers that are known only when the planes are made.
  virtual void add_cards(const std::vector<HeaderCard>& cards) = 0;
  /// To be called once, after all else.
  virtual void finish() = 0;
};

}  // namespace misfit::imager
