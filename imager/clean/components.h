#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "imager/data/image.h"
#include "imager/taylor/taylor_expansion.h"

namespace misfit::imager {

/// Flux that CLEAN found at a pixel: a point, or a round Gaussian centred on it.
struct Component {
  int scale = 0;  ///< which of the model's scales
  int row = 0;
  int column = 0;
  double flux_jy = 0;
  std::array<double, most_taylor_terms - 1> further_jy{};  ///< of a spectrum, its Taylor coefficients after this one, I_0

  double coefficient_jy(int term) const { return term == 0 ? flux_jy : further_jy[static_cast<std::size_t>(term - 1)]; }
};

/// A model made of components. Components at one place and scale are one. Equal components added in the same order give equal
/// bits, whatever they are divided into; a model made anew from its components() has the same bits.
class ComponentModel {
 public:
  ComponentModel() = default;
  /// `scale_pixels`: the full width at half maximum of each scale's Gaussian; 0 for points.
  ComponentModel(int width, int height, std::vector<double> scale_pixels);

  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<double>& scale_pixels() const { return scale_pixels_; }
  /// The components, one at a place and scale, in the order of scale, row, column; none whose flux is 0 at every frequency.
  const std::vector<Component>& components() const { return components_; }

  /// Throws std::invalid_argument when one of them lies outside the image or has no scale of the model.
  void add(const std::vector<Component>& found);
  double flux_jy() const;
  /// The image of a Taylor term, Jy/pixel. Gaussians are those of gaussian_taps; their parts beyond the image are lost.
  Image image(int threads, int term = 0) const;

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<double> scale_pixels_;
  std::vector<Component> components_;
};

/// The pixels of an image that are neither 0 nor NaN as point components of scale 0.
std::vector<Component> components_of(const Image& image);
/// Point components of the images of Taylor terms: of pixels that are neither 0 nor NaN in at least one of them.
std::vector<Component> components_of(const std::vector<const Image*>& terms);

}  // namespace misfit::imager
