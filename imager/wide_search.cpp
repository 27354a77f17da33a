#include "imager/wide_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "imager/clean/clean.h"
#include "imager/clean/deconvolver.h"
#include "imager/constants.h"
#include "imager/noise.h"
#include "imager/planned_transform.h"
#include "imager/tapered_visibilities.h"

namespace misfit::imager {
namespace {

constexpr int times_wider = 4;
constexpr int most_doublings = 12;

/// What cells of the image's, doubled so many times, can do with, in all blocks so far.
struct Doublings {
  std::uint64_t usable = 0;
  std::array<std::uint64_t, most_doublings + 1> inner{};  ///< samples with |u|, |v| below 1/(4 cell)
  std::array<double, most_doublings + 1> max_abs_w{};     ///< of those below 1/(2 cell)
};

void count(const VisibilityBlock& block, double cell_rad, Doublings& found) {
  const float* weight = block.weight.data();
  for (std::size_t row = 0; row < block.rows(); ++row) {
    const double* uvw_m = &block.uvw_m[3 * row];
    const double reach_m = std::max(std::abs(uvw_m[0]), std::abs(uvw_m[1]));
    for (const double frequency_hz : block.frequency_hz) {
      if (*weight++ == 0) continue;
      ++found.usable;
      const double per_m = frequency_hz / speed_of_light_m_s;
      double turns = reach_m * per_m * cell_rad;
      for (std::size_t k = 0; k <= most_doublings && turns <= 0.5; ++k, turns *= 2) {
        found.inner[k] += turns <= 0.25;
        found.max_abs_w[k] = std::max(found.max_abs_w[k], std::abs(uvw_m[2]) * per_m);
      }
    }
  }
}

GriddingPlan plan_of(const VisibilitySource& source, const WideField& field, int threads) {
  GriddingRequest request;
  request.geometry = field.geometry;
  request.accuracy = request.psf_accuracy = 1e-4;
  request.best_effort = true;
  request.samples = source.samples();
  request.max_abs_w = field.max_abs_w;
  request.threads = threads;
  return plan_gridding(request);
}

}  // namespace

WideField wide_field(const VisibilitySource& source, const ImageGeometry& image) {
  Doublings found;
  const auto stream = source.open();
  while (const auto block = stream->next()) count(*block, image.cell_rad, found);
  const double pixels = times_wider * std::max(image.width, image.height);
  std::size_t doublings = 2;
  while (doublings < most_doublings && std::ldexp(pixels, -static_cast<int>(doublings)) > 1024) ++doublings;
  while (doublings > 0 && found.inner[doublings] * 10 < found.usable) --doublings;
  WideField field{image, found.max_abs_w[doublings]};
  const auto coarse = [&](int side) {
    return std::max(2, static_cast<int>(std::ceil(std::ldexp(times_wider * side, -static_cast<int>(doublings)))));
  };
  field.geometry.width = coarse(image.width);
  field.geometry.height = coarse(image.height);
  field.geometry.cell_rad = std::ldexp(image.cell_rad, static_cast<int>(doublings));
  return field;
}

WideSearch search_wide_field(const VisibilitySource& source, const WideField& field, int threads, const Progress& progress,
                             StageTimes& times) {
  const TaperedVisibilities tapered(source, field.geometry.cell_rad);
  const PlannedTransform transform(plan_of(tapered, field, threads));
  const DirtyImages images = make_dirty_images(tapered, transform, true, progress, times);
  constexpr double deep = 5e-3;  // a source between pixels leaves less of itself
  CleanOptions options;
  options.max_iterations = 5000;
  options.max_major_cycles = 10;
  options.nsigma = 5;
  options.threshold_jy = deep * largest_magnitude(images.dirty);
  options.threads = threads;
  const auto minor = make_deconvolver({.name = "clark", .threads = threads}, images.psf);
  const ImageGeometry& g = field.geometry;
  const Sidelobes sidelobes(images.psf);
  constexpr double lobe_pixels = 5;  // where the main lobe is over
  CleanResult cleaned = clean(
      {tapered, transform, images, sidelobes.from(lobe_pixels), 1e-4}, *minor, options,
      first_state(ComponentModel(g.width, g.height, minor->scale_pixels())), progress, [](const CleanState&) {}, times);
  const Unexplained unexplained = unexplained_by(cleaned.model, source, transform, g, progress, times);
  return {cleaned.components.components(), sidelobes,
          std::max(5 * robust_noise(cleaned.residual, threads), options.threshold_jy), unexplained,
          unexplained.sources_most_jy * sidelobes.from(lobe_pixels)};
}

}  // namespace misfit::imager
