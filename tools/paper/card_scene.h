#pragma once

#include <Eigen/Core>
#include <complex>
#include <string>
#include <vector>

#include "imager/data/geometry.h"
#include "imager/data/image.h"
#include "imager/data/source.h"
#include "imager/data/visibilities.h"

namespace misfit::tools {

/// The scene to simulate. Its sources lie on multiples of 15 cells of the card, so that they are pixels where 15 is a multiple
/// of `cells_a_pixel`.
struct CardSceneOptions {
  int pixels = 800;  ///< of both axes
  int cells_a_pixel = 1;
  std::string array = "vla-a";  ///< see antenna_array
  int integrations = 4;         ///< spread over six hours around transit
  int threads = 1;
};

/// The paper's 34 sources (test_card, on cells of 0.05") seen by an array at 4 GHz and declination 40°, w taken as 0, without
/// noise, all weights 1.
struct CardScene {
  imager::ImageGeometry geometry;
  std::vector<imager::Source> sources;
  imager::VisibilityBlock block;
  std::vector<std::complex<double>> visibility;  ///< [row][channel], Jy, in doubles
  imager::Image direct;                          ///< direct sums, not divided by Σ w
  /// √(½ Σ |V|²): the RMS of such sums where the phases of V are random.
  double random_rms = 0;
};

CardScene card_scene(const CardSceneOptions& options);

/// RMS error of an image, in strips |x| = const (all y) and |y| = const (all x) taken together, and of the whole.
struct MisfitProfile {
  std::vector<double> x;    ///< of the strip's middle: offset from the phase centre / size of the FFT
  std::vector<double> rms;  ///< relative to CardScene::random_rms
  double whole = 0;
};

/// The misfit of `gridded` against the scene's direct sums.
MisfitProfile measured_misfit(const imager::Image& gridded, const CardScene& scene, int fft_size);

/// The errors of the transform along an axis at the offsets of 0, 1 … pixels/2 pixels: the mean over all positions in a cell of
/// 1 − h Σ_r C_r exp(2πi s_r x), and of its square.
struct AxisErrors {
  Eigen::VectorXd mean_square;  ///< ℓ
  Eigen::VectorXd mean;
};

/// The misfit to be expected: the mean scales the image I, and the rest is as random as positions in cells are,
///   (b(x) + b(y))² I² + (ℓ(x) − b(x)² + ℓ(y) − b(y)²) random_rms²
/// at a pixel for a mean of b, averaged over strips.
MisfitProfile expected_misfit(const AxisErrors& errors, const CardScene& scene, int fft_size);

/// Offsets of 0, 1 … pixels/2 pixels / size of the FFT.
Eigen::VectorXd pixel_offsets(int pixels, int fft_size);

}  // namespace misfit::tools
