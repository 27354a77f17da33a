#pragma once

#include <memory>
#include <optional>

#include "imager/arrays/array_samples.h"
#include "imager/data/image.h"
#include "imager/plan/gridding_plan.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

/// Where the pixels of an image in an array lie: pixel [i][j] at x = centre_x + (i − pixels_x/2) · pixel_x and
/// y = centre_y + (j − pixels_y/2) · pixel_y, the divisions by 2 of whole numbers. In radians, as direction cosines.
struct ArrayImage {
  int pixels_x = 0;
  int pixels_y = 0;
  double pixel_x_rad = 0;
  double pixel_y_rad = 0;
  double centre_x = 0;
  double centre_y = 0;
};

struct ArrayTransformOptions {
  ArrayImage image;
  double accuracy = 1e-6;      ///< ε: ‖I − I_DFT‖₂ ≤ ε ‖I_DFT‖₂, see ArrayTransform
  bool divide_by_n = false;    ///< whether pixels are divided by n, in images and models; where w is taken as 0, n is 1
  double least_padding = 1.1;  ///< bounds of FFT size over image size
  double most_padding = 2.6;
  kernels::KernelFamily kernel = kernels::kernel_family("least-misfit");
  int kernel_width = 0;                ///< cells along each axis of u and v; 0: as narrow as the accuracy allows
  std::optional<Precision> precision;  ///< of gridding and FFTs; none: single if that is enough
  int threads = 1;                     ///< 0: all
};

/// The adjoint of an array's samples, and how far it may err.
struct ArrayAdjoint {
  Image image;  ///< [x][y]: Σ w Re[V exp(+2πi(ux + vy − w(n−1)))], not divided by Σ w; 0 beyond the horizon
  double expected_error = 0;  ///< RMS over the image's own RMS: above the accuracy where the data cancel
};

/// The transform of visibilities in arrays and its adjoint: ArrayCoordinates' equation, and the sum in ArrayAdjoint. The
/// accuracy is relative to data, or pixels, of random phases. The plan depends on the options and coordinates alone, so that
/// both ways are linear, and each is the other's adjoint up to the plan's rounding. Samples beyond 1/(2 pixel) count: pixels
/// are points. Pixels beyond the horizon are 0, and not looked at in a model.
class ArrayTransform {
 public:
  /// `at` must outlive this. Throws std::invalid_argument as check_coordinates and plan_gridding do, and for images without
  /// pixels.
  ArrayTransform(const ArrayTransformOptions& options, const ArrayCoordinates& at);

  /// The plan; it has no decisions where every pixel lies beyond the horizon.
  const GriddingPlan& plan() const { return plan_; }
  /// Throws std::invalid_argument where shapes differ, or a visibility that counts is not finite.
  template <typename Real>
  ArrayAdjoint adjoint(const ArrayValues<Real>& values) const;
  /// Writes weight · V into `into`, 0 where the mask is. Throws std::invalid_argument where shapes differ, or a pixel is not
  /// finite. Where it throws later, because UVW is not finite or a StopCheck ends it, `into` is written in part.
  template <typename Real>
  void predict(const Strided<const Real>& model, const Strided<const Real>& weight,
               const Strided<std::complex<Real>>& into) const;

 private:
  double n_at(int row, int column) const;
  template <typename Real>
  Image model_of(const Strided<const Real>& model) const;

  ArrayTransformOptions options_;
  const ArrayCoordinates& at_;
  ArrayBlockOptions blocks_;
  bool nothing_seen_ = false;  ///< every pixel lies beyond the horizon
  GriddingPlan plan_;
  std::unique_ptr<Transform> transform_;  ///< null where every pixel lies beyond the horizon
};

/// The plan of such a transform, and of a PSF if one is made besides.
GriddingPlan plan_of(const ArrayTransformOptions& options, const ArrayCoordinates& at, bool with_psf = false);

/// The decisions for such a transform, and their reasons. Axes are the grid's: its u is along y, its v along x.
Plan decisions_of(const GriddingPlan& plan);

}  // namespace misfit::imager
