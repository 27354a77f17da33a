#pragma once

#include <vector>

#include "imager/data/image.h"

namespace misfit::imager {

/// How high a PSF still is away from its peak, which is 1.
class Sidelobes {
 public:
  /// A PSF with its peak in the middle pixel. It is known as far as it reaches; farther off its sidelobes are taken to be as
  /// high as the highest beyond a quarter of its shorter side, which are those of many baselines too.
  explicit Sidelobes(const Image& psf);

  /// The largest magnitude at a separation of so many pixels or more along one axis; 1 below one pixel.
  double from(double pixels) const;
  /// Of any separation, however large.
  double far() const { return highest_.back(); }
  /// No separation shall have less.
  void raise_to(double level);

 private:
  std::vector<double> highest_;  ///< by whole pixels; the last for all beyond
};

}  // namespace misfit::imager
