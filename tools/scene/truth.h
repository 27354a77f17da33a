#pragma once

#include <complex>
#include <vector>

#include "imager/direct/direct_transform.h"
#include "imager/transform/imaging.h"

namespace misfit::tools {

/// Errors of an image and of predicted visibilities against the direct transform, relative to the RMS of the whole image,
/// or of the visibilities.
struct SceneErrors {
  double rms = 0;
  double rms_noise = 0;  ///< one standard error of it for the choice of pixels, as a part of it
  double max = 0;
  double centre_rms = 0;  ///< in the inner half of the image
  double centre_max = 0;
  double border_rms = 0;  ///< within a sixteenth of its sides from its edge, corners among them
  double border_max = 0;
  double predict_rms = 0;  ///< NaN where no prediction was compared
  double predict_noise = 0;
  double predict_max = 0;

  /// The errors where nothing was measured: NaN all over.
  static SceneErrors none();
};

/// The direct transform of a scene: the dirty image at some pixels, and the visibilities of a model of some pixels at some
/// samples; the choice is the same for the same scene.
class SceneTruth {
 public:
  /// One pass over the samples. `pixels` of the centre, as many of the border, as many between. Throws imager::NothingUsable.
  SceneTruth(const imager::VisibilitySource& source, const imager::ImageGeometry& geometry, int pixels, int threads,
             const imager::Progress& progress);

  /// ±1 Jy in some pixels, the corners among them.
  const imager::Image& model() const { return model_; }
  /// The errors of an image in Jy/beam; predicted visibilities are not compared.
  SceneErrors errors_of(const imager::Image& dirty) const;
  /// Adds what one block of a pass predicted; blocks are to come in their order.
  void compare(std::size_t block, const std::vector<std::complex<double>>& predicted, SceneErrors& errors) const;
  /// To be called when all blocks were compared.
  void finish(SceneErrors& errors) const;

  /// The counts of samples that were read and left out.
  const imager::SampleCounts& counts() const { return counts_; }
  /// Seconds that the direct sums took for each pixel.
  double seconds_a_pixel() const { return seconds_a_pixel_; }

 private:
  enum Place : int { centre, between, border, places };
  struct ChosenSample {
    std::size_t block = 0;
    std::size_t sample = 0;
    std::complex<double> visibility;
  };
  struct ChosenPixel {
    imager::Pixel at;
    Place place = centre;
    double share = 0;  ///< of the image's pixels; 0 = a corner, that the largest error is looked for at alone
  };
  void choose_pixels(int count);

  imager::ImageGeometry geometry_;
  std::vector<ChosenPixel> pixel_;
  std::vector<double> direct_;
  std::vector<ChosenSample> samples_;
  imager::Image model_;
  imager::SampleCounts counts_;
  double visibility_square_ = 0;
  double seconds_a_pixel_ = 0;
};

}  // namespace misfit::tools
