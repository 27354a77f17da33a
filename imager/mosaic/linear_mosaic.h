#pragma once

#include "imager/data/image.h"

namespace misfit::imager {

/// A pointing's plane on the pixels of a mosaic.
struct MosaicPart {
  const Image& apparent;  ///< D, the sky times the beam, Jy/beam; NaN where it is not known
  const Image& beam;      ///< B; NaN where it is not known
  double noise_jy = 0;    ///< σ of D, Jy/beam, the same everywhere
};

/// A plane of a mosaic and what belongs to it.
struct MosaicPlane {
  Image sky;     ///< Jy/beam
  Image weight;  ///< W, 1/(Jy/beam)²
  Image noise;   ///< 1/√W, the sky's standard deviation, Jy/beam
  Image beam;    ///< √(W/max W), the joint beam
};

/// The sky that fits the images of pointings p best, by least squares, pixel by pixel:
///     sky = Σ_p B_p D_p/σ_p² / W,   W = Σ_p B_p²/σ_p²
/// (Cornwell 1988, A&A 202, 316; Sault, Staveley-Smith & Brouw 1996, A&AS 120, 375, equation 5). A point of flux S at x₀ that
/// pointings have restored with the beam G is S G(x − x₀) Σ_p B_p(x₀) B_p(x)/σ_p² / W(x): S at x₀ itself, and by the variance
/// of G times the gradient of the logarithm beside it, as in every image that is divided by a beam.
class LinearMosaic {
 public:
  /// A pointing takes part where its own beam is this or more. Below, where fits to measured beams end, the beam's relative
  /// error is large, and W would grow by at most a 400th of the pointing's own.
  static constexpr double least_beam = 0.05;

  LinearMosaic(int width, int height) : sum_(width, height), weight_(width, height) {}

  /// Adds a pointing. The number of threads does not change a bit. Throws std::invalid_argument where the noise is not above 0,
  /// or sizes differ.
  void add(const MosaicPart& part, int threads);
  /// All that was added; NaN where the joint beam is below `limit`, and where no pointing takes part.
  MosaicPlane finished(double limit) const;

 private:
  Image sum_;     ///< Σ B D/σ²
  Image weight_;  ///< Σ B²/σ²
};

}  // namespace misfit::imager
