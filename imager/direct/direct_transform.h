#pragma once

#include <utility>

#include "imager/data/geometry.h"
#include "imager/direct/sample_response.h"
#include "imager/direct/source_sums.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

struct DirectSums {
  ImageGeometry geometry;
  bool with_w = true;  ///< otherwise w is taken as 0
  int threads = 1;
};

/// The defining sums in double precision: the oracle that everything else is measured against, and the fastest way where
/// samples or sources are few. Costs samples × pixels.
class DirectTransform : public Transform {
 public:
  explicit DirectTransform(const DirectSums& sums) : sums_(sums) {}
  DirectTransform(const ImageGeometry& geometry, int threads) : sums_{geometry, true, threads} {}

  std::unique_ptr<AdjointSum> adjoint(const AdjointOptions& options) const override;
  /// Only the pixels that are not 0 cost time.
  std::unique_ptr<Prediction> predict(Image model) const override;
  std::vector<std::complex<double>> psf_source(const SampleCoordinates& at) const override;

 private:
  DirectSums sums_;
};

/// A pixel of an image.
struct Pixel {
  int row = 0;
  int column = 0;
};

/// Pixels at which direct sums are taken.
struct DirectPixels {
  ImageGeometry geometry;
  std::vector<Pixel> pixel;
  bool with_w = true;
  int threads = 1;
  std::shared_ptr<const SampleResponse> response = {};  ///< null: samples see all of them alike
};

/// Some pixels of an image, by direct sums: an adjoint's images are as many pixels wide and one high. Predictions are left to
/// another transform, of the whole image, which must outlive this.
class PixelTransform : public Transform {
 public:
  PixelTransform(DirectPixels at, const Transform& whole) : at_(std::move(at)), whole_(whole) {}

  std::unique_ptr<AdjointSum> adjoint(const AdjointOptions& options) const override;
  std::unique_ptr<Prediction> predict(Image model) const override { return whole_.predict(std::move(model)); }
  std::vector<std::complex<double>> psf_source(const SampleCoordinates& at) const override { return whole_.psf_source(at); }

 private:
  DirectPixels at_;
  const Transform& whole_;
};

/// Adds the direct sums of `block`, for one image or of all its Stokes parameters: sum[image][k] += Σ w B Re[V
/// exp(−2πi(ul+vm+w(n−1)))] with the response B. Samples beyond 1/(2 cell) are left out, as in imaging.
void add_direct_pixels(const VisibilityBlock& block, const DirectPixels& at, std::vector<std::vector<double>>& sum);

}  // namespace misfit::imager
