#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>

#include "imager/numerics/context.h"
#include "imager/transform/normalisation.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

/// Thrown where every usable sample lies beyond 1/(2 cell).
struct NothingInGrid : std::runtime_error {
  explicit NothingInGrid(std::uint64_t samples);
  std::uint64_t outside_grid = 0;
};

/// Where several ranks share the samples, images are at rank 0, and empty at others, here and wherever images are made; all
/// other fields are about all samples and the images, at every rank.
struct DirtyImages {
  std::vector<Image> dirty;                       ///< [Stokes], Jy/beam: the adjoint, normalised
  Image psf;                                      ///< 1 at the centre up to the accuracy; empty unless asked for
  std::vector<SampleSums> sums;                   ///< [Stokes]
  std::vector<ImageStatistics> dirty_statistics;  ///< [Stokes], as the images are made
  ImageStatistics psf_statistics;
  Normalisation normalisation{1};  ///< of all of them, which residuals share
};

/// One pass over the visibilities. Stages timed: "read", "grid", "fft", which counts corrections in. Throws std::runtime_error
/// when no sample can be used; NothingInGrid where all lie beyond the grid.
DirtyImages make_dirty_images(const VisibilitySource& source, const Transform& transform, const AdjointOptions& options,
                              const Context& context);

/// A PSF made by a transform of its own.
struct OwnPsf {
  const Transform& transform;
  int images = 1;  ///< images made by the other transform, see AdjointOptions
};

/// Makes dirty images, and the PSF by a transform of its own, in the same pass.
DirtyImages make_dirty_images(const VisibilitySource& source, const Transform& transform, const OwnPsf& psf,
                              const Context& context);

/// Gets a block and its data − model [row][channel], which is defined at usable samples alone.
using VisitResidual = std::function<void(const VisibilityBlock& block, const std::vector<std::complex<double>>& residual)>;

/// Makes one pass over data − model; every rank has the model. Stages timed: "read", "fft", "degrid".
void for_each_residual(const OneStokes& samples, const Transform& transform, Image model, const Context& context,
                       const VisitResidual& visit);

/// Makes the pass with a model whose prediction is made once the pass has begun.
using MakePrediction = std::function<std::unique_ptr<Prediction>()>;
void for_each_residual(const OneStokes& samples, const MakePrediction& predict, const Context& context,
                       const VisitResidual& visit);

/// Samples of one Stokes parameter, and how models are predicted for them and images made of them.
struct ImagedData {
  OneStokes samples;
  const Transform& transform;
  Normalisation normalisation;  ///< of their dirty images
};

/// The dirty image of data − model: the model is predicted at every usable sample and
/// subtracted. Stages timed: "read", "fft", "degrid", "grid".
Image make_residual_image(const ImagedData& imaged, Image model, const Context& context);

}  // namespace misfit::imager
