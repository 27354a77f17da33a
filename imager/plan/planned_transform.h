#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "imager/direct/direct_transform.h"
#include "imager/plan/gridding_plan.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

/// True if residuals of a plan take so long that coarser ones are worth it, and its kernel and padding were not given.
bool may_be_coarser(const GriddingPlan& plan);

/// The transform of a plan: gridding and FFTs, or direct sums where the plan found them cheaper.
class PlannedTransform : public Transform {
 public:
  explicit PlannedTransform(const GriddingPlan& plan);

  std::unique_ptr<AdjointSum> adjoint(const AdjointOptions& options) const override { return images_->adjoint(options); }
  /// By direct sums over a model of few pixels, with w even where gridding may leave it out.
  std::unique_ptr<Prediction> predict(Image model) const override;
  std::vector<std::complex<double>> psf_source(const SampleCoordinates& at) const override { return psf().psf_source(at); }
  Normalisation normalisation(const AdjointResult& sums) const override { return images_->normalisation(sums); }
  /// The transform that makes images, and predicts larger models.
  const Transform& images() const { return *images_; }
  /// Transforms of the same samples for residuals that need not be as exact, and are made in less time: the least exact first.
  /// None unless may_be_coarser(). Planned when they are first asked for.
  const std::vector<CoarserTransform>& coarser() const;
  /// The transform that makes PSFs: images(), or one of their own.
  const Transform& psf() const { return psf_ ? *psf_ : *images_; }

 private:
  std::unique_ptr<Transform> images_;
  std::unique_ptr<Transform> psf_;  ///< null where images and PSF share one
  DirectSums direct_;
  std::uint64_t direct_pixels_;
  GriddingRequest request_;
  double residual_cost_s_ = 0;  ///< 0 where none may be coarser
  mutable std::once_flag planned_coarser_;
  mutable std::vector<CoarserTransform> coarser_;
};

}  // namespace misfit::imager
