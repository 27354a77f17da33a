#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "imager/data/image.h"
#include "imager/data/ranks.h"
#include "imager/data/visibility_sets.h"
#include "imager/transform/normalisation.h"

namespace misfit::imager {

/// Sums over the samples that an adjoint took in.
struct SampleSums {
  std::uint64_t used = 0;
  std::uint64_t outside_grid = 0;  ///< usable samples beyond |u| or |v| = 1/(2 cell), left out unless they are asked for
  double weight = 0;               ///< Σ w
  double weight_abs = 0;           ///< Σ w |V|
  double weight_square = 0;        ///< Σ w |V|²
  double weight2_square = 0;       ///< Σ w² |V|²

  /// Root mean square of the visibilities, in Jy; 0 where there are none.
  double data_jy() const { return weight > 0 ? std::sqrt(weight_square / weight) : 0; }
  SampleSums& operator+=(const SampleSums& other);
  /// Adds the sums of all other ranks.
  void add_up(const Ranks& ranks);
};

/// The images that an adjoint makes of the samples.
struct AdjointOptions {
  int images = 1;  ///< of a block's own Stokes parameter, or of all that it carries, up to most_stokes; 0: the PSF alone
  bool with_psf = false;
  /// True if samples beyond 1/(2 cell) count too, as they do in the definition: pixels are points, whose values are periodic in
  /// u and v but for the phase of the middle one. Their sum is no picture of the sky.
  bool beyond_grid = false;
  /// True if a transform that does not see all pixels alike gives its sensitivity in each, see AdjointResult.
  bool with_sensitivity = false;
  /// The highest power k for which it also gives the sensitivity with w x^k, with x = ν/ν_0 − 1.
  int sensitivity_powers = 0;
  double sensitivity_reference_hz = 0;  ///< ν_0
};

/// Images made from all samples added, not yet divided by Σ w.
struct AdjointResult {
  /// [Stokes]: Σ w Re[V exp(−2πi(ul+vm+w(n−1)))]; NaN beyond the horizon.
  std::vector<Image> images;
  /// The image with V = exp(+2πi(u l_0 + v m_0 + w(n_0−1))), the response to a source of 1 Jy in the image's middle pixel,
  /// where it is Σ w; empty unless it was asked for. It is NaN where w counts and that pixel lies beyond the horizon.
  Image psf;
  std::vector<SampleSums> sums;  ///< [Stokes]; they differ in |V| alone. For a PSF alone: of the blocks' own visibilities
  /// The contribution of a source of 1 Jy in each pixel to the sum of that pixel; empty where it is Σ w in all pixels, or was
  /// not asked for.
  Image sensitivity;
  std::vector<Image> further_sensitivity;  ///< [k − 1]: the sensitivity with w x^k
  double fft_s = 0;  ///< seconds of wall clock that FFTs and corrections took, as samples were added and at the end
};

/// The adjoint transform, accumulated block by block. Adding the same blocks in the same order gives the same bits.
class AdjointSum {
 public:
  virtual ~AdjointSum() = default;
  /// Throws std::invalid_argument when several images are made and the block does not carry as many Stokes parameters.
  void add(const VisibilityBlock& block) { add_sets(block, {block, static_cast<int>(sets())}); }
  /// Adds the samples of `block` with other visibilities in place of its own, a set for each image. Throws
  /// std::invalid_argument unless there are as many.
  void add(const VisibilityBlock& block, const VisibilitySets& visibility);
  /// To be called once, after the last block.
  virtual AdjointResult finish() = 0;

 protected:
  /// Throws std::invalid_argument when nothing is to be made, or there are to be too many images.
  explicit AdjointSum(const AdjointOptions& options);
  /// Adds a block's samples with a set of visibilities for each image; for a PSF alone with the block's own, for the sums.
  virtual void add_sets(const VisibilityBlock& block, const VisibilitySets& sets) = 0;
  std::size_t images() const { return static_cast<std::size_t>(options_.images); }
  std::size_t sets() const { return images() == 0 ? 1 : images(); }

  const AdjointOptions options_;
};

/// The forward transform of one model image.
class Prediction {
 public:
  virtual ~Prediction() = default;
  /// V [row][channel] at every coordinate, beyond 1/(2 cell) too: but for the phase of the image's middle pixel the model is
  /// periodic in u and v.
  virtual std::vector<std::complex<double>> at(const SampleCoordinates& coordinates) const = 0;
  /// V [row][channel] where the block's weight is not 0, and 0 elsewhere.
  virtual std::vector<std::complex<double>> at_usable(const VisibilityBlock& block) const = 0;
  /// at_usable of each block. [block][row][channel]
  virtual std::vector<std::vector<std::complex<double>>> at_usable_of(const std::vector<const VisibilityBlock*>& blocks) const;
  /// The best number of samples to ask for together, where every call takes FFTs; 0 = any number.
  virtual std::size_t samples_at_once() const { return 0; }
  /// Seconds of wall clock that FFTs and corrections have taken since this was made.
  virtual double fft_s() const { return 0; }
};

/// The linear operator A of interferometric imaging and its adjoint,
///   V(u,v,w) = Σ_pixels I(l,m) exp(+2πi(ul+vm+w(n−1))),   u, v, w = UVW · frequency / c,
/// in one of several implementations. The sum leaves out pixels beyond the horizon, whatever they hold. With the same samples,
/// ⟨A x, y⟩ = ⟨x, A* y⟩ (real parts) up to rounding.
class Transform {
 public:
  virtual ~Transform() = default;
  virtual std::unique_ptr<AdjointSum> adjoint(const AdjointOptions& options) const = 0;
  virtual std::unique_ptr<Prediction> predict(Image model) const = 0;
  /// The visibilities of the source whose response is the PSF of an adjoint. [row][channel]
  virtual std::vector<std::complex<double>> psf_source(const SampleCoordinates& at) const = 0;
  /// How adjoints of this transform become images, given the sums of all samples.
  virtual Normalisation normalisation(const AdjointResult& sums) const { return Normalisation(sums.sums.front().weight); }
};

/// A transform that costs less than another, and is less exact.
struct CoarserTransform {
  double accuracy;  ///< see GriddingRequest
  std::shared_ptr<const Transform> transform;
};

}  // namespace misfit::imager
