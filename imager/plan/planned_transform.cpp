#include "imager/plan/planned_transform.h"

#include <algorithm>
#include <utility>

#include "imager/plan/cost_model.h"
#include "imager/plan/mosaic_plan.h"

namespace misfit::imager {
namespace {

std::unique_ptr<Transform> transform_of(const GriddingPlan& plan, const DirectSums& direct) {
  if (plan.windows) return make_mosaic_transform(plan);
  if (plan.direct) return std::make_unique<DirectTransform>(direct);
  return make_transform(plan.options);
}

/// The seconds of making a residual image.
double residual_cost_s(const GriddingPlan& plan) {
  if (plan.windows) return mosaic_seconds(*plan.windows, 1);
  GriddingWork work = plan.choice.best.work;
  work.stokes = 1;
  work.psf = false;
  return CostModel().seconds(work);
}

}  // namespace

bool may_be_coarser(const GriddingPlan& plan) {
  constexpr double worth_s = 0.1;
  return !plan.direct && plan.request.kernel_width == 0 && plan.request.padding == 0 && residual_cost_s(plan) >= worth_s;
}

PlannedTransform::PlannedTransform(const GriddingPlan& plan)
    : direct_{plan.options.geometry, true, plan.options.threads}, direct_pixels_(plan.direct_pixels), request_(plan.request) {
  images_ = transform_of(plan, direct_);
  if (plan.psf) psf_ = transform_of(*plan.psf, direct_);
  if (may_be_coarser(plan)) residual_cost_s_ = residual_cost_s(plan);
}

const std::vector<CoarserTransform>& PlannedTransform::coarser() const {
  constexpr double pays = 0.85;  // of the cost of the next more exact
  std::call_once(planned_coarser_, [this] {
    if (residual_cost_s_ == 0) return;
    GriddingRequest request = request_;
    request.stokes = 1;
    request.psf = false;
    double least_cost_s = residual_cost_s_;
    for (const double accuracy : {1e-4, 1e-3, 1e-2}) {
      if (accuracy < 2 * request_.accuracy) continue;
      request.accuracy = accuracy;
      const GriddingPlan plan = plan_gridding(request);
      if (plan.direct || residual_cost_s(plan) > pays * least_cost_s) continue;
      least_cost_s = residual_cost_s(plan);
      coarser_.insert(coarser_.begin(), {accuracy, std::make_shared<PlannedTransform>(plan)});
    }
  });
  return coarser_;
}

std::unique_ptr<Prediction> PlannedTransform::predict(Image model) const {
  const auto pixels = std::count_if(model.pixel.begin(), model.pixel.end(), [](double x) { return x != 0; });
  if (static_cast<std::uint64_t>(pixels) <= direct_pixels_) return DirectTransform(direct_).predict(std::move(model));
  return images_->predict(std::move(model));
}

}  // namespace misfit::imager
