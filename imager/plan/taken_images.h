#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "imager/direct/direct_transform.h"
#include "imager/plan/gridding_plan.h"

namespace misfit::imager {

/// Images that a run before made.
struct FormerImages {
  std::vector<Image> dirty;  ///< [Stokes], Jy/beam
  Image psf;
};

/// Which former images are taken instead of new ones, once they are seen to be of the same samples.
struct TakenImages {
  bool dirty = false;
  bool psf = false;
  bool of_model = false;  ///< `dirty` are residuals of a model, with which the data alone cannot be compared
  /// Called at rank 0, once there are samples that make an image.
  std::function<FormerImages()> read;

  bool any() const { return dirty || psf; }
};

/// Which image is meant.
struct ImageKind {
  bool psf = false;        ///< else a residual
  std::size_t stokes = 0;  ///< of a residual
  int order = 0;           ///< of its Taylor term, or of a PSF's power
};

/// Thrown where an image that was to be taken is not an image of the samples.
struct UnlikeSamples : std::runtime_error {
  UnlikeSamples(const ImageKind& of_kind, const std::string& what) : std::runtime_error(what), kind(of_kind) {}
  ImageKind kind;
};

/// Pixels of images of a plan, by direct sums, with which images are compared: those about the middle, where the PSF's main
/// lobe is, and others at random, fewer where there are many samples.
class ComparedPixels {
 public:
  /// `whole` predicts models for transform(), and must outlive this.
  ComparedPixels(const GriddingPlan& plan, const Transform& whole);

  /// A transform whose adjoints are images of these pixels alone.
  const Transform& transform() const { return transform_; }
  /// Throws UnlikeSamples unless `image` has these `values`. The RMS difference over the pixels may be 1e-2 of `rms`, the RMS
  /// of the image or of what its errors are relative to; or three times the accuracy where that is more, but no more than a
  /// tenth. Two runs that keep the accuracy differ by at most twice the accuracy, and the RMS over a few pixels may be more
  /// than over all. Pixels beyond the horizon do not count.
  void require(const Image& image, const Image& values, double rms, double accuracy, const ImageKind& kind) const;

 private:
  std::vector<Pixel> pixels_;
  PixelTransform transform_;
};

}  // namespace misfit::imager
