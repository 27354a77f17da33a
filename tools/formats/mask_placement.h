#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "imager/files/image_reader.h"
#include "imager/files/sky_grid.h"

namespace misfit::tools {

/// How the image of a mask lies on the pixels of another image: a pixel takes what the mask says in its own pixel nearest to
/// that direction, in whatever projection, frame and turn, and is not allowed where the mask has none there. An image that does
/// not say where it lies on the sky is laid on pixel by pixel.
class MaskPlacement {
 public:
  /// Places the mask in `file`, which is at `path`, beside an image of this header. Throws std::runtime_error that names the
  /// mask and what was expected, where it covers none of the image, says nothing of the sky and has another size, or moves
  /// along with its field and the image does not.
  MaskPlacement(const imager::ImageReader& file, const std::string& path, const imager::ImageHeader& image);

  /// A sentence for the user on the placement; empty where the mask has the image's pixels.
  const std::string& sentence() const { return sentence_; }
  /// 1 where the plane of the mask allows components, 0 elsewhere.
  imager::Image lay(const imager::ImageReader& file, const imager::PlaneIndex& at) const;

 private:
  /// The pixel of the mask for a pixel of the image, counted along rows from 0; −1 where the mask has none.
  std::int64_t nearest(int row, int column) const;
  bool covers_any() const;
  bool covers_all() const;  ///< where pixels lie on pixels

  imager::ImageGeometry image_;
  int width_ = 0, height_ = 0;          ///< of the mask
  std::optional<imager::GridMap> map_;  ///< none where pixels lie on pixels
  int right_ = 0, up_ = 0;              ///< without a map, pixel (row + up, column + right) of the mask is for (row, column)
  std::string sentence_;
};

}  // namespace misfit::tools
