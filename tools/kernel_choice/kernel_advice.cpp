#include "tools/kernel_choice/kernel_advice.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "imager/data/extent.h"
#include "imager/plan/out_of_reach.h"
#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

void refuse(bool wrong, const std::string& option, double value, const std::string& expected) {
  if (wrong) throw std::invalid_argument("--" + option + " " + significant(value, 6) + ": expected " + expected);
}

std::string padding_of(const imager::GriddingCandidate& c) {
  const std::string u = significant(c.padding_u, 3);
  return c.padding_u == c.padding_v ? u : u + " along u, " + significant(c.padding_v, 3) + " along v";
}

std::string candidate(const imager::GriddingCandidate& c) {
  std::string text = "width " + std::to_string(c.work.width) + ", padding " + padding_of(c);
  if (c.work.has_w_axis())
    text += "; along w width " + std::to_string(c.work.width_w) + ", padding " + significant(c.padding_w, 3) + ", " +
            std::to_string(c.work.planes) + " planes";
  return text;
}

}  // namespace

imager::GriddingChoice choose_for(const KernelJob& job) {
  constexpr int largest = 65536;
  refuse(!(job.accuracy > 0 && job.accuracy < 1), "accuracy", job.accuracy, "a number above 0 and below 1");
  for (const int size : job.imsize) refuse(size < 1 || size > largest, "imsize", size, "1 to 65536 pixels");
  refuse(!(job.w_turns >= 0 && job.w_turns <= 1e6), "w-turns", job.w_turns, "0 (two axes) to 1e6");
  const auto refuse_samples = [&](bool wrong) {
    refuse(wrong, "samples", job.samples, "the number of visibilities, 1 to 1e18, beside --accuracy");
  };
  refuse_samples(job.samples != 0 && !(job.samples >= 1 && job.samples <= 1e18));
  if (job.imsize.empty())
    throw std::invalid_argument("expected --imsize, the image's width, or width and height, beside --accuracy");
  refuse_samples(job.samples == 0);
  imager::GriddingRequest request;
  constexpr double any_cell = 1e-6;
  request.geometry = {job.imsize.front(), job.imsize.back(), any_cell, {}};
  request.accuracy = job.accuracy;
  request.kernel = choose_kernel(job.kernel);
  request.samples = static_cast<std::uint64_t>(job.samples);
  request.max_abs_w = job.w_turns * 2 * std::numbers::pi / imager::max_w_phase_rad(1, request.geometry);
  request.gridder = job.w_turns > 0 ? imager::Gridder::wide : imager::Gridder::standard;
  request.facets = false;
  imager::GriddingChoice choice = imager::choose_gridding(request);
  if (!choice.reached) throw std::invalid_argument(imager::out_of_reach(request, choice));
  return choice;
}

std::string text_of(const imager::GriddingChoice& choice, const imager::CostModel& costs) {
  const imager::GriddingCandidate& best = choice.best;
  const bool single = best.work.precision == imager::Precision::single_precision;
  std::string text = "chosen: " + candidate(best) + ", polynomials of degree " + std::to_string(best.work.degree) + ", " +
                     (single ? "single" : "double") + " precision\n";
  text += "  FFT         " + std::to_string(best.work.nu) + " × " + std::to_string(best.work.nv) + "\n";
  text += "  error       " + significant(best.worst_error, 2) + " at the worst position or pixel, " +
          significant(best.expected_error, 2) + " expected\n";
  text += "  time        " + significant(costs.seconds(best.work), 2) +
          " s on one core of this machine, image and PSF (W² multiply-adds a visibility and N log N for the FFTs: " +
          significant(imager::operation_count(best.work), 2) + " operations)\n";
  for (const imager::RejectedCandidate& r : choice.rejected) {
    const bool dear = r.reason == imager::Rejection::costs_more;
    text += "  rejected    " + candidate(r.candidate) + ": " +
            (dear ? significant(costs.seconds(r.candidate.work), 2) + " s, " +
                        significant(r.candidate.cost_s / best.cost_s, 3) + " times the cost by the fixed constants\n"
                  : "its error is " + significant(r.candidate.worst_error, 2) + "\n");
  }
  return text;
}

}  // namespace misfit::tools
