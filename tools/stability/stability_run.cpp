#include "tools/stability/stability_run.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <utility>

#include "imager/clean/deconvolver.h"
#include "imager/data/extent.h"
#include "imager/data/noise.h"
#include "imager/data/stored_visibilities.h"
#include "imager/direct/verify.h"
#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"
#include "tools/run/beam_choice.h"
#include "tools/stability/extended_sums.h"

namespace misfit::tools {
namespace {

imager::UvwReach reach_of(const imager::VisibilityBlock& block) {
  imager::UvwReach reach;
  const double highest = *std::max_element(block.frequency_hz.begin(), block.frequency_hz.end());
  for (std::size_t row = 0; row < block.rows(); ++row) {
    const auto in_wavelengths = [&](std::size_t axis) {
      return std::abs(block.uvw_m[3 * row + axis]) * highest / imager::speed_of_light_m_s;
    };
    reach.max_abs_u = std::max(reach.max_abs_u, in_wavelengths(0));
    reach.max_abs_v = std::max(reach.max_abs_v, in_wavelengths(1));
    reach.max_abs_w = std::max(reach.max_abs_w, in_wavelengths(2));
  }
  return reach;
}

/// The request for a case, by gridding however few the samples: direct sums have no kernel to test.
imager::GriddingRequest request_of(const StabilityCase& asked, double accuracy) {
  imager::GriddingRequest request;
  request.geometry = asked.geometry;
  request.accuracy = accuracy;
  request.samples = asked.repeats * asked.block->samples();
  request.threads = imager::available_threads();
  request.max_abs_w = reach_of(*asked.block).max_abs_w;
  const double phase_rad = imager::max_w_phase_rad(request.max_abs_w, request.geometry);
  request.gridder = phase_rad > imager::neglected_part * accuracy ? imager::Gridder::wide : imager::Gridder::standard;
  return request;
}

struct PlanOrRefusal {
  imager::GriddingPlan plan;
  std::string refusal;
};

/// Plans as asked; or, where that is refused, as exactly as possible, and notes why.
PlanOrRefusal plan_or_refusal(imager::GriddingRequest request) {
  try {
    return {imager::plan_gridding(request), ""};
  } catch (const std::invalid_argument& refused) {
    request.best_effort = true;
    return {imager::plan_gridding(request), refused.what()};
  }
}

/// True if one plan serves both requests: all other parts of cases' requests are equal.
bool alike(const imager::GriddingRequest& a, const imager::GriddingRequest& b) {
  const imager::ImageGeometry &g = a.geometry, &h = b.geometry;
  return a.accuracy == b.accuracy && a.samples == b.samples && a.max_abs_w == b.max_abs_w && a.gridder == b.gridder &&
         g.width == h.width && g.height == h.height && g.cell_rad == h.cell_rad && g.centre.l == h.centre.l &&
         g.centre.m == h.centre.m;
}

/// Makes plans that serve several cases once: kernels take longer to solve than small cases to run.
class PlanShelf {
 public:
  PlanOrRefusal plan(const imager::GriddingRequest& request) {
    for (const auto& [made_for, plan] : plans_)
      if (alike(made_for, request)) return plan;
    plans_.emplace_back(request, plan_or_refusal(request));
    return plans_.back().second;
  }

 private:
  std::vector<std::pair<imager::GriddingRequest, PlanOrRefusal>> plans_;
};

/// Some samples of a block, in the order in which they are drawn.
imager::SampleCoordinates random_samples(const imager::VisibilityBlock& block, int count) {
  std::mt19937_64 random(1);
  imager::SampleCoordinates some{{}, {block.frequency_hz[random() % block.channels()]}};
  for (int i = 0; i < count; ++i) {
    const double* const uvw_m = &block.uvw_m[3 * (random() % block.rows())];
    some.uvw_m.append(uvw_m, uvw_m + 3);
  }
  return some;
}

double predict_error(const imager::VisibilityBlock& block, const imager::Transform& transform,
                     const imager::ImageGeometry& geometry, const std::vector<imager::Pixel>& pixels) {
  imager::Image model(geometry.width, geometry.height);
  double sign = 1;
  for (const imager::Pixel& pixel : pixels) model.at(pixel.row, pixel.column) = sign = -sign;
  const imager::SampleCoordinates at = random_samples(block, 100);
  const auto exact = extended_visibilities(at, geometry, model);
  const auto predicted = transform.predict(model)->at(at);
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    difference += std::norm(predicted[i] - exact[i]);
    size += std::norm(exact[i]);
  }
  return std::sqrt(difference / size);
}

ExtendedError measure(const StabilityCase& asked, const imager::AccurateImages& made) {
  const double affordable = 3e6 / static_cast<double>(asked.block->samples());
  const std::vector<imager::Pixel> pixels =
      imager::random_pixels(asked.geometry, static_cast<int>(std::clamp(affordable, 16.0, 200.0)));
  const imager::PixelError of_pixels = imager::pixel_error(
      made.images.dirty.front(), pixels, extended_pixels(*asked.block, asked.geometry, pixels), imager::Normalisation(1));
  const double image_rms = imager::root_mean_square(made.images.dirty.front());
  return {of_pixels.rms / image_rms, of_pixels.max / image_rms,
          predict_error(*asked.block, made.transform->images(), asked.geometry, pixels)};
}

bool is_finite(const imager::Image& image) {
  return std::all_of(image.pixel.begin(), image.pixel.end(), [](double x) { return std::isfinite(x); });
}

/// The PSF's largest sidelobe outside its main lobe; 1 where no beam fits that.
double max_sidelobe(const imager::Image& psf, double cell_rad) {
  const BeamChoice beams = choose_beam(psf, cell_rad, {}, false);
  if (!beams.main_lobe) return 1;
  return imager::largest_sidelobe(psf, *beams.main_lobe, cell_rad, imager::available_threads());
}

imager::CleanReport clean(const StabilityCase& asked, const imager::VisibilitySource& source,
                          const imager::AccurateImages& made, double accuracy) {
  imager::CleanOptions options;
  options.max_iterations = asked.max_iterations;
  options.threshold_jy = asked.threshold_jy;
  options.max_major_cycles = asked.max_major_cycles;
  options.threads = imager::available_threads();
  const auto minor = imager::make_deconvolver({"hogbom", {0}, 0, options.threads}, {&made.images.psf});
  const imager::ComponentModel empty(asked.geometry.width, asked.geometry.height, minor->scale_pixels());
  return imager::clean({.imaged = {source, *made.transform, made.images.normalisation},
                        .dirty = {made.images.dirty.front()},
                        .psf = {&made.images.psf},
                        .max_sidelobe = max_sidelobe(made.images.psf, asked.geometry.cell_rad),
                        .accuracy = accuracy},
                       *minor, options, imager::first_state(empty), [](const imager::CleanState&) {}, {})
      .report;
}

StabilityOutcome run_with(PlanShelf& shelf, const StabilityCase& asked, double accuracy) {
  StabilityOutcome outcome;
  outcome.name = asked.name;
  outcome.accuracy = accuracy;
  outcome.max_iterations = asked.max_iterations;
  imager::StoredVisibilities source;
  for (std::uint64_t i = 0; i < asked.repeats; ++i) source.append(asked.block);
  PlanOrRefusal planned = shelf.plan(request_of(asked, accuracy));
  outcome.refusal = planned.refusal;
  planned.plan.options.geometry = planned.plan.request.geometry = asked.geometry;
  const imager::AccurateImages made = imager::make_accurate_images(source, std::move(planned.plan), {});
  outcome.single = made.plan.options.precision == imager::Precision::single_precision;
  outcome.promise_kept = made.promise_kept;
  imager::WSpread spread;
  spread.add(*asked.block);
  outcome.theory =
      imager::theoretical_error(made.plan, made.images.sums.front(), imager::root_mean_square(made.images.dirty.front()),
                                imager::neglected_w_phase(reach_of(*asked.block), spread, asked.geometry));
  outcome.finite = is_finite(made.images.dirty.front()) && is_finite(made.images.psf);
  if (!outcome.finite) return outcome;
  outcome.measured = measure(asked, made);
  outcome.clean = clean(asked, source, made, std::max(accuracy, outcome.theory.expected_rms));
  return outcome;
}

}  // namespace

bool StabilityOutcome::honest() const {
  const bool exact = measured.rms <= accuracy && measured.predict_rms <= accuracy;
  return exact || !refusal.empty() || !promise_kept;
}

std::vector<StabilityOutcome> run_cases(const std::vector<StabilityCase>& cases) {
  PlanShelf shelf;
  std::vector<StabilityOutcome> outcomes;
  for (const StabilityCase& asked : cases)
    for (const double accuracy : {1e-4, 1e-9}) outcomes.push_back(run_with(shelf, asked, accuracy));
  return outcomes;
}

}  // namespace misfit::tools
