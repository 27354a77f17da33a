#include "imager/plan/planned_transform.h"

#include <algorithm>

namespace misfit::imager {
namespace {

std::unique_ptr<Transform> transform_of(const GriddingPlan& plan, const DirectSums& direct) {
  if (plan.direct) return std::make_unique<DirectTransform>(direct);
  return make_transform(plan.options);
}

}  // namespace

PlannedTransform::PlannedTransform(const GriddingPlan& plan)
    : direct_{plan.options.geometry, true, plan.options.threads}, direct_pixels_(plan.direct_pixels) {
  images_ = transform_of(plan, direct_);
  if (plan.psf) psf_ = make_transform(plan.psf->options);
}

std::unique_ptr<Prediction> PlannedTransform::predict(const Image& model) const {
  const auto pixels = std::count_if(model.pixel.begin(), model.pixel.end(), [](double x) { return x != 0; });
  if (static_cast<std::uint64_t>(pixels) <= direct_pixels_) return DirectTransform(direct_).predict(model);
  return images_->predict(model);
}

}  // namespace misfit::imager
