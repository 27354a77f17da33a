#include "imager/outside/wide_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "imager/clean/clean.h"
#include "imager/clean/deconvolver.h"
#include "imager/clean/shared_model.h"
#include "imager/data/noise.h"
#include "imager/numerics/constants.h"
#include "imager/outside/tapered_visibilities.h"
#include "imager/plan/planned_transform.h"
#include "imager/transform/sampling.h"

namespace misfit::imager {
namespace {

constexpr int times_wider = 4;
constexpr double lobe_pixels = 5;  ///< where the main lobe is over

/// A wider field after CLEAN, whose own memory is given back.
struct CleanedField {
  ComponentModel components;
  Image model;
  Sidelobes sidelobes{Image()};
  double least_jy = 0;
};

CleanedField clean_wide_field(const VisibilitySource& source, const Transform& transform, const ImageGeometry& g,
                              const Context& context) {
  const TaperedVisibilities tapered(source, g.cell_rad);
  const DirtyImages images = make_dirty_images(tapered, transform, {.with_psf = true}, context);
  const ImagedData imaged{tapered, transform, images.normalisation};
  const Ranks& ranks = source.ranks();
  CleanedField field;
  if (!ranks.first()) {
    follow_clean(imaged, {}, {}, context);
    field.model = Image(g.width, g.height);
    ranks.share(field.model.pixel.data(), field.model.pixel.size() * sizeof(double));
    return field;
  }
  const Image& dirty = images.dirty.front();
  constexpr double deep = 2e-3;           // a source between pixels leaves hardly more of itself
  constexpr double least_of_peak = 7e-3;  // fainter components may be remains of such sources
  CleanOptions options;
  options.max_iterations = 5000;
  options.max_major_cycles = 10;
  options.nsigma = 5;
  options.threshold_jy = deep * largest_magnitude(dirty);
  options.threads = context.threads;
  const auto minor = make_deconvolver({.threads = context.threads}, {&images.psf});
  const Sidelobes sidelobes(images.psf);
  CleanResult cleaned = clean(
      {.imaged = imaged, .dirty = {dirty}, .psf = {&images.psf}, .max_sidelobe = sidelobes.from(lobe_pixels), .accuracy = 1e-4},
      *minor, options, first_state(ComponentModel(g.width, g.height, minor->scale_pixels())), [](const CleanState&) {},
      context);
  ranks.share(cleaned.model.pixel.data(), cleaned.model.pixel.size() * sizeof(double));
  return {std::move(cleaned.components), std::move(cleaned.model), sidelobes,
          std::max(5 * robust_noise(cleaned.residual, context.threads), least_of_peak * largest_magnitude(dirty))};
}

}  // namespace

void WideFieldFinder::add(const SampleCoordinates& samples) {
  samples_ += samples.samples();
  for (std::size_t row = 0; row < samples.rows(); ++row) {
    const double* uvw_m = &samples.uvw_m[3 * row];
    const double reach_m = std::max(std::abs(uvw_m[0]), std::abs(uvw_m[1]));
    for (const double frequency_hz : samples.frequency_hz) {
      const double per_m = frequency_hz / speed_of_light_m_s;
      double turns = reach_m * per_m * image_.cell_rad;
      for (std::size_t k = 0; k <= most_doublings && turns <= 0.5; ++k, turns *= 2) {
        inner_[k] += turns <= 0.25;
        max_abs_w_[k] = std::max(max_abs_w_[k], std::abs(uvw_m[2]) * per_m);
      }
    }
  }
}

void WideFieldFinder::add_up(const Ranks& ranks) {
  sum_over(ranks, samples_);
  for (std::uint64_t& count : inner_) sum_over(ranks, count);
  ranks.largest(max_abs_w_.data(), max_abs_w_.size());
}

WideField WideFieldFinder::field() const {
  const double pixels = times_wider * std::max(image_.width, image_.height);
  std::size_t doublings = 2;
  while (doublings < most_doublings && std::ldexp(pixels, -static_cast<int>(doublings)) > 1024) ++doublings;
  constexpr double fewest_pixels = 64;  // a main lobe, its neighbours, and room for noise
  while (doublings > 0 &&
         (inner_[doublings] * 10 < samples_ || std::ldexp(pixels, -static_cast<int>(doublings)) < fewest_pixels))
    --doublings;
  const auto coarse = [&](int side) {
    return std::max(2, static_cast<int>(std::ceil(std::ldexp(times_wider * side, -static_cast<int>(doublings)))));
  };
  WideField field{image_, max_abs_w_[doublings], 0};
  field.geometry.width = coarse(image_.width);
  field.geometry.height = coarse(image_.height);
  field.geometry.cell_rad = std::ldexp(image_.cell_rad, static_cast<int>(doublings));
  if (samples_ > 0) field.reaching = static_cast<double>(inner_[doublings]) / static_cast<double>(samples_);
  return field;
}

GriddingPlan plan_wide_field(const WideField& field, const GriddingRequest& image) {
  GriddingRequest request;
  request.geometry = field.geometry;
  request.accuracy = request.psf_accuracy = 1e-4;
  request.best_effort = true;
  request.samples = image.samples;
  request.max_abs_w = field.max_abs_w;
  request.threads = image.threads;
  request.stack_bytes = image.stack_bytes;
  request.samples_at_once = image.samples_at_once;
  return plan_gridding(request);
}

bool can_be_imaged(const ImageGeometry& field, const VisibilitySource& source) {
  bool any = false;
  const auto stream = source.open();
  while (const auto block = any ? nullptr : stream->next()) {
    SampleSums sums;
    const std::vector<float> weight = imaging_weights(*block, {field, false, 1}, sums);
    any = sums.used > 0;
  }
  return any_of(source.ranks(), any);
}

WideSearch search_wide_field(const VisibilitySource& source, const GriddingPlan& plan, const Context& context) {
  const ImageGeometry& g = plan.request.geometry;
  const PlannedTransform transform(plan);
  const CleanedField cleaned = clean_wide_field(source, transform, g, {plan.request.threads, context.times, context.progress});
  const Unexplained unexplained = unexplained_by(cleaned.model, source, transform, g, context);
  return {cleaned.components.components(), cleaned.sidelobes, cleaned.least_jy, unexplained,
          unexplained.sources_most_jy * cleaned.sidelobes.from(lobe_pixels)};
}

}  // namespace misfit::imager
