#pragma once

#include <vector>

#include "imager/data/image.h"

namespace misfit::imager {

/// How high a PSF still is away from its peak, which is 1.
class Sidelobes {
 public:
  /// A PSF with its peak in the middle pixel. Beyond its reach sidelobes are taken to be as high as the highest beyond a
  /// quarter of its shorter side, where many baselines add up, too.
  explicit Sidelobes(const Image& psf);

  /// The largest magnitude at a separation of so many pixels or more along one axis; 1 below one pixel.
  double from(double pixels) const;
  /// The largest magnitude at the largest separations.
  double far() const { return highest_.back(); }
  /// Raises all separations to this level at least.
  void raise_to(double level);

 private:
  std::vector<double> highest_;  ///< by whole pixels; the last for all beyond
};

}  // namespace misfit::imager
