#pragma once

#include <cstddef>
#include <vector>

namespace misfit::imager {

/// A plane of pixels, row-major [row][column] = [m][l]; see ImageGeometry for where they lie.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<double> pixel;  ///< [height][width]

  Image() = default;
  Image(int image_width, int image_height)
      : width(image_width),
        height(image_height),
        pixel(static_cast<std::size_t>(image_width) * static_cast<std::size_t>(image_height)) {}

  double* row(int r) { return pixel.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(width); }
  const double* row(int r) const { return pixel.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(width); }
  double& at(int r, int column) { return row(r)[column]; }
  double at(int r, int column) const { return row(r)[column]; }
};

/// Functions that need not know where each image lies take pointers to them.
inline std::vector<const Image*> pointers_to(const std::vector<Image>& images) {
  std::vector<const Image*> pointers;
  for (const Image& image : images) pointers.push_back(&image);
  return pointers;
}
/// The images of all Taylor terms, or of all powers, where the first is kept by itself.
inline std::vector<const Image*> all_terms(const Image& first, const std::vector<Image>& further) {
  std::vector<const Image*> terms{&first};
  for (const Image& image : further) terms.push_back(&image);
  return terms;
}

/// Takes an image off another of the same size.
inline void subtract(const Image& image, Image& from) {
  for (std::size_t i = 0; i < from.pixel.size(); ++i) from.pixel[i] -= image.pixel[i];
}

}  // namespace misfit::imager
