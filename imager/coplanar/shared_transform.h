#pragma once

#include <functional>
#include <memory>

#include "imager/coplanar/coplanar_transform.h"
#include "imager/coplanar/sample_shares.h"

namespace misfit::imager {

/// The adjoint I_k = A* Σ c̄_k w V of a SharedTransform.
class SharedAdjoint {
 public:
  virtual ~SharedAdjoint() = default;
  /// Adds a block's samples with these visibilities, a set for each of what is made.
  virtual void add(const VisibilityBlock& block, const VisibilitySets& sets, const SampleShares& shares) = 0;
  /// Tells of image after image, of each set in order. To be called once, after the last block.
  virtual void finish(const std::function<void(std::size_t set, std::size_t image, const Image& made)>& take) = 0;
  virtual double fft_s() const = 0;  ///< see AdjointResult
};

/// The prediction V = Σ_k c_k A I_k.
class SharedPrediction {
 public:
  virtual ~SharedPrediction() = default;
  /// V [row][channel] where the block's weight is not 0, and 0 elsewhere.
  virtual std::vector<std::complex<double>> at_usable(const VisibilityBlock& block, const SampleShares& shares) const = 0;
  virtual double fft_s() const = 0;
};

/// The transform in two dimensions of several images at once, in each of which every sample has a share of its own: order,
/// coordinates and taps serve all. Its errors are those of one transform of what the images add up to for a sample.
class SharedTransform {
 public:
  virtual ~SharedTransform() = default;
  /// Takes up to most_stokes sets of visibilities, and makes `images` of each; sets × images are most_shared_images at most.
  virtual std::unique_ptr<SharedAdjoint> adjoint(std::size_t sets, std::size_t images) const = 0;
  /// Predicts what up to most_shared_images images make together.
  virtual std::unique_ptr<SharedPrediction> predict(const std::vector<Image>& images) const = 0;
};

/// Throws as make_coplanar_transform() does.
std::unique_ptr<SharedTransform> make_shared_transform(const CoplanarOptions& options);

}  // namespace misfit::imager
