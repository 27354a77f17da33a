#include "imager/accurate_imaging.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace misfit::imager {
namespace {

/// RMS of the dirty image of data with random phases: √(½ Σ w²|V|²) / Σ w.
double random_image_rms(const SampleSums& sums) {
  return std::sqrt(0.5 * sums.weight2_square) / sums.weight;
}

AccurateImages make_images(const VisibilitySource& source, const GriddingRequest& request, const Progress& progress,
                           StageTimes& times) {
  AccurateImages made;
  {
    const StageTimer timer(times, "plan");
    made.plan = plan_gridding(request);
    made.transform = make_plane_transform(made.plan.options);
  }
  made.images = make_dirty_images(source, *made.transform, true, progress, times);
  return made;
}

/// How many times larger than that of random data relative to the image the kernel's error may be.
double weakness(const DirtyImages& images) {
  const double image = root_mean_square(images.dirty);
  return image == 0 ? 1 : std::max(1.0, random_image_rms(images.sums) / image);
}

}  // namespace

double root_mean_square(const Image& image) {
  double square = 0;
  for (const double pixel : image.pixel) square += pixel * pixel;
  return std::sqrt(square / static_cast<double>(std::max<std::size_t>(image.pixel.size(), 1)));
}

TheoreticalError theoretical_error(const GriddingPlan& plan, const SampleSums& sums, double image_rms,
                                   const NeglectedPhase& w) {
  const double phase_rms = std::min(w.rms_rad, std::sqrt(2.0));  // unit phasors at random are √2 apart
  const double phase_max = std::min(w.max_rad, 2.0);
  const auto over_image = [image_rms](double x) { return x == 0 ? 0 : x / image_rms; };
  const double flux = over_image(sums.weight_abs / sums.weight);
  TheoreticalError error;
  error.expected_rms = std::hypot(plan.expected_error, phase_rms) * std::max(1.0, over_image(random_image_rms(sums)));
  error.bound_rms = ((1 + plan.bound_rms) * (1 + phase_max) - 1) * flux;
  error.bound_max = ((1 + plan.bound_max) * (1 + phase_max) - 1) * flux;
  return error;
}

AccurateImages make_accurate_images(const VisibilitySource& source, const GriddingRequest& request, const Progress& progress,
                                    StageTimes& times) {
  AccurateImages made = make_images(source, request, progress, times);
  double weak = 1;
  {
    const StageTimer timer(times, "statistics");
    weak = weakness(made.images);
  }
  const auto keeps = [&] { return request.accuracy == 0 || made.plan.expected_error * weak <= request.accuracy; };
  if (!keeps()) {
    GriddingRequest stricter = request;
    stricter.accuracy = request.accuracy / weak;
    stricter.best_effort = true;
    const double first = made.plan.expected_error;
    made = make_images(source, stricter, progress, times);
    char because[160];
    std::snprintf(because, sizeof because,
                  "the image is %.3g times weaker than random data of this size would give, so the expected error was %.2g",
                  weak, first * weak);
    made.plan.decisions.push_back({"second pass", "with a more exact kernel", because});
  }
  made.promise_kept = keeps();
  return made;
}

}  // namespace misfit::imager
