#include "imager/plan/gridding_plan.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "imager/numerics/constants.h"
#include "imager/plan/mosaic_plan.h"
#include "imager/plan/out_of_reach.h"
#include "imager/plan/plan_text_internal.h"

namespace misfit::imager {
namespace {

std::string width_and_padding(const GriddingCandidate& c) {
  return "width " + std::to_string(c.work.width) + " at padding " + text("%.2f", c.padding_u);
}

/// "width 9 at padding 1.40 costs 1.21×, width 7 at padding 1.60 reaches 2e-6"
std::string text_of(const GriddingChoice& choice) {
  std::string all;
  for (const RejectedCandidate& r : choice.rejected) {
    const bool dear = r.reason == Rejection::costs_more;
    all += (all.empty() ? "" : ", ") + width_and_padding(r.candidate) +
           (dear ? " costs " + text("%.2f×", r.candidate.cost_s / choice.best.cost_s)
                 : " reaches " + text("%.2g", r.candidate.worst_error));
  }
  return all;
}

std::string times(int a, int b) {
  return std::to_string(a) + " × " + std::to_string(b);
}

/// The decisions on w.
Plan w_decisions(const GriddingRequest& request, const GriddingChoice& choice) {
  const std::string phase = "its phase reaches " + text("%.2g", choice.w_phase_rad) + " rad over this image";
  const GriddingWork& work = choice.best.work;
  if (!work.has_w_axis())
    return {{"w planes", "left out",
             request.gridder == Gridder::standard ? "asked for, although " + phase
                                                  : phase + ", less than what the accuracy leaves to it"}};
  const Faceting& way = choice.best.faceting;
  const double turns = choice.w_phase_rad / (2 * pi);
  const double left = *std::max_element(way.turns.begin(), way.turns.end());
  const bool whole_image = way.along_l * way.along_m == 1;
  const double whole = static_cast<double>(request.geometry.width) * request.geometry.height;
  const double equal = work.planes * (static_cast<double>(way.width) * way.height) / whole;
  const std::string again = work.gathers == 1
                                ? ""
                                : "; made " + std::to_string(work.gathers) + " times, since memory gathers no more than " +
                                      text("%.2g", static_cast<double>(request.samples_at_once)) + " samples at once";
  return {{"w axis", "width " + std::to_string(work.width_w) + " at padding " + text("%.2f", choice.best.padding_w), phase},
          {"facets", times(way.along_l, way.along_m),
           whole_image ? "the whole image on one plane leaves " + text("%.3g", left) + " turns to the w axis"
                       : "each on its own tangent plane: at most " + text("%.3g", left) + " of " + text("%.3g", turns) +
                             " turns are left to the w axis"},
          {"w planes", std::to_string(work.planes) + " in all facets, w ≥ 0 alone",
           "FFTs as of " + text("%.1f", equal) + " planes of the whole image; V(−u, −v, −w) = conj V(u, v, w)" + again}};
}

Plan decisions_of(const GriddingRequest& request, const GriddingPlan& plan) {
  const WideTransformOptions& o = plan.options;
  const bool single = o.precision == Precision::single_precision;
  const std::string because_accuracy = request.accuracy == 0 ? "as asked"
                                                             : "worst position within a cell, or pixel at the corner, gives " +
                                                                   text("%.2g", plan.worst_error) + ", accuracy asked " +
                                                                   text("%.2g", request.accuracy);
  const std::string because_evaluation = request.lookup || !request.shortest_polynomials
                                             ? "as asked"
                                             : "adds less than 0.5% to the squared error, rounding counted in";
  GriddingCandidate in_single = plan.choice.best;
  in_single.work.precision = Precision::single_precision;
  judge(in_single);
  const std::string rejected = text_of(plan.choice);
  const std::string others = rejected.empty() ? "" : "; " + rejected;
  Plan decisions = {
      {"kernel", o.kernel_u.name, "expected error of random data " + text("%.2g", plan.expected_error)},
      {"kernel width", std::to_string(o.kernel_u.width()), because_accuracy},
      {"FFT size", times(o.nu, o.nv),
       "padding " + text("%.3f", plan.choice.best.padding_u) + " along u is the cheapest that keeps the accuracy" + others},
      {"FFT pruning", std::to_string(plan.choice.best.work.columns) + " of " + std::to_string(o.nu) + " columns",
       "only those that the image keeps are transformed along v"},
      {"kernel evaluation", evaluation_of(o), because_evaluation},
      {"precision of grid and FFT", single ? "single" : "double",
       request.precision ? "as asked; rounding adds " + text("%.1g", plan.rounding)
       : single
           ? "rounding adds " + text("%.1g", plan.rounding)
           : "single precision would add " + text("%.1g", in_single.rounding) + " of rounding" +
                 (request.accuracy < request.single_from ? ", and is not trusted below " + text("%.0e", request.single_from)
                                                         : ", or cost more")},
  };
  if (request.stokes > 1)
    decisions.push_back(
        {"Stokes parameters", std::to_string(request.stokes) + " gridded at once", "order, coordinates and taps serve all"});
  const Plan of_w = w_decisions(request, plan.choice);
  decisions.insert(decisions.end(), of_w.begin(), of_w.end());
  if (!o.has_w_axis())
    decisions.push_back({"half of the uv plane", "gridded alone",
                         "the image is real, so V(−u, −v) = conj V(u, v): half the memory, half the FFT"});
  return decisions;
}

}  // namespace

void check_request(const GriddingRequest& request) {
  const kernels::KernelFamily& family = request.kernel;
  if (request.kernel_width != 0 && (request.kernel_width < family.min_width || request.kernel_width > family.max_width))
    throw std::invalid_argument("--kernel-width " + std::to_string(request.kernel_width) + ": expected " +
                                std::to_string(family.min_width) +
                                (family.max_width == family.min_width ? "" : " to " + std::to_string(family.max_width)) +
                                ", which kernel " + family.name + " has");
  if (request.padding != 0 && !(request.padding >= 1.02 && request.padding <= 10))
    throw std::invalid_argument("--padding " + text("%g", request.padding) + ": expected 1.02 to 10");
  if (!(request.least_padding >= 1.02 && request.least_padding <= request.most_padding && request.most_padding <= 10))
    throw std::invalid_argument("paddings from " + text("%g", request.least_padding) + " to " +
                                text("%g", request.most_padding) + ": expected 1.02 to 10, in ascending order");
  constexpr double typed = 1e-3;  // what a padding of four digits may be off by
  if (request.padding != 0 && request.padding < (1 - typed) * 0.5 / family.max_x0)
    throw std::invalid_argument("--padding " + text("%g", request.padding) + ": expected at least " +
                                text("%.4g", 0.5 / family.max_x0) + ", since kernel " + family.name + " is made for x0 up to " +
                                text("%.4g", family.max_x0));
  if (!(request.max_abs_w >= 0 && std::isfinite(request.max_abs_w)))
    throw std::invalid_argument("largest |w| is " + text("%g", request.max_abs_w) + " wavelengths, expected 0 or more");
  if (!(request.accuracy >= 0 && request.accuracy < 1))
    throw std::invalid_argument("accuracy " + text("%g", request.accuracy) + ": expected a number above 0 and below 1");
  if (!(request.psf_accuracy >= 0 && request.psf_accuracy < 1))
    throw std::invalid_argument("accuracy of the PSF " + text("%g", request.psf_accuracy) +
                                ": expected a number above 0 and below 1");
}

GriddingPlan with_threads(GriddingPlan plan, int threads) {
  plan.request.threads = plan.options.threads = threads;
  if (plan.psf) plan.psf = std::make_shared<const GriddingPlan>(with_threads(*plan.psf, threads));
  if (plan.windows) {
    auto windows = std::make_shared<WindowsPlan>(*plan.windows);
    share_threads(*windows, threads);
    plan.windows = std::move(windows);
  }
  return plan;
}

std::string evaluation_of(const CoplanarOptions& options) {
  if (!options.lookup) return "polynomials of degree " + std::to_string(options.kernel_u.polynomial.degree());
  return text(*options.lookup);
}

namespace {

/// Rounding where all samples lie in one cell, which makes it largest, for a noise gain of 1: sums that grow evenly are half
/// their last value on average, and each addition errs by a unit of what the sum is; taps, products and the FFT by some more.
double adverse_rounding(const WideTransformOptions& options, double samples) {
  const double unit = options.precision == Precision::single_precision ? 0x1p-24 : 0x1p-53;
  constexpr double taps_and_fft = 8;
  return unit * (taps_and_fft + longest_sum(options, samples) / 2);
}

/// |1 − R_u R_v R_w| ≤ (1 + |1 − R_u|)(1 + |1 − R_v|)(1 + |1 − R_w|) − 1 for the responses R of the axes. Over the pixels the
/// RMS of products of u and v is that of the factors; q is spread over them in its own way, so that along w the largest counts.
void set_bounds(GriddingPlan& plan) {
  const GriddingCandidate& best = plan.choice.best;
  constexpr double between = 1.02;  // maxima were looked for at points, and means taken as integrals
  const auto all = [](double u, double v, double w) {
    return (1 + between * std::sqrt(u)) * (1 + between * std::sqrt(v)) * (1 + between * std::sqrt(w)) - 1;
  };
  const kernels::Misfit &u = best.u.misfit, &v = best.v.misfit, &w = best.w.misfit;
  const double rounding = adverse_rounding(plan.options, best.work.samples);
  const double largest_gain = best.u.largest_gain * best.v.largest_gain * best.w.largest_gain;
  const double gain = best.u.noise_gain * best.v.noise_gain * best.w.largest_gain;
  constexpr double several = 6;  // steps that lead to a phase, each rounded by less than the law's RMS
  const double phases = several * phase_rounding(best.turns);
  plan.bound_rms = all(u.worst_mean, v.worst_mean, w.worst) + gain * rounding + phases;
  plan.bound_max = all(u.worst, v.worst, w.worst) + largest_gain * rounding + phases;
}

/// A plan with one transform for all images. `what` names the accuracy in the error for one out of reach.
GriddingPlan plan_together(const GriddingRequest& request, const std::string& what = "accuracy") {
  GriddingPlan plan;
  plan.request = request;
  plan.choice = choose_gridding(request);
  const GriddingCandidate& best = plan.choice.best;
  if (!plan.choice.reached && !request.best_effort) throw std::invalid_argument(out_of_reach(request, plan.choice, what));
  static_cast<CoplanarOptions&>(plan.options) = {request.geometry, best.work.nu,        best.work.nv,    best.u.kernel,
                                                 best.v.kernel,    best.work.precision, request.threads, request.lookup};
  if (best.work.has_w_axis()) {
    plan.options.kernel_w = best.w.kernel;
    plan.options.facets_l = best.faceting.along_l;
    plan.options.facets_m = best.faceting.along_m;
    plan.options.stack_bytes = request.stack_bytes;
    plan.options.samples_at_once = request.samples_at_once;
  }
  plan.expected_error = best.expected_error;
  plan.rounding = best.rounding;
  plan.worst_error = best.worst_error;
  set_bounds(plan);
  plan.decisions = decisions_of(request, plan);
  return plan;
}

/// True if neither a kernel nor a way of gridding was asked for.
bool free_to_choose(const GriddingRequest& r) {
  return r.kernel.name == GriddingRequest().kernel.name && r.accuracy != 0 && r.kernel_width == 0 && r.padding == 0 &&
         r.gridder == Gridder::automatic && r.precision != Precision::single_precision && !r.lookup && r.shortest_polynomials &&
         r.samples > 0;
}

/// Seconds of direct sums, a pixel.
double direct_pixel_s(const GriddingRequest& request) {
  return 1e-9 * CostModel().direct_ns * static_cast<double>(request.samples);
}

/// Images that direct sums make, in units of the cost of one: Stokes parameters share the phasors, which cost most.
double direct_images(const GriddingRequest& request) {
  constexpr double sum_alone = 0.25;
  return 1 + sum_alone * (request.stokes - 1) + (request.psf ? 1 : 0);
}

/// Has models of few pixels predicted by direct sums.
void use_direct_predictions(GriddingPlan& plan) {
  if (!free_to_choose(plan.request)) return;
  GriddingWork one = plan.choice.best.work;
  one.stokes = 1;
  one.psf = false;
  plan.direct_pixels = static_cast<std::uint64_t>(CostModel().seconds(one) / direct_pixel_s(plan.request));
  if (plan.direct_pixels > 0)
    plan.decisions.push_back({"prediction",
                              "by direct sums for models of up to " + std::to_string(plan.direct_pixels) + " pixels",
                              "FFTs and degridding cost less only for more"});
}

/// Has the images made by direct sums where that costs less.
void use_direct_images(GriddingPlan& plan, double gridding_s) {
  const GriddingRequest& r = plan.request;
  if (!free_to_choose(r)) return;
  const double pixels = static_cast<double>(r.geometry.pixels());
  const double direct_s = direct_images(r) * pixels * direct_pixel_s(r);
  const double turns = 0.25 * (r.geometry.width + r.geometry.height) + plan.choice.w_phase_rad / (2 * pi);
  const double rounding = phase_rounding(turns);
  if (direct_s >= gridding_s || rounding > r.accuracy) return;
  plan.direct = true;
  plan.psf.reset();
  plan.direct_pixels = r.geometry.pixels();
  plan.expected_error = plan.worst_error = plan.rounding = rounding;
  plan.bound_rms = plan.bound_max = 6 * plan.rounding;
  plan.decisions = {
      {"images and predictions", "by direct sums",
       "for so few samples they cost " + text("%.2g", direct_s / gridding_s) + " of gridding and FFTs; w counts in full"}};
}

Decision psf_decision(const GriddingPlan& plan, double together_s) {
  if (!plan.psf) return {"PSF", "shares the image's transform", "taps, order and coordinates serve both"};
  const WideTransformOptions& o = plan.psf->options;
  const double apart_s = plan.choice.best.cost_s + plan.psf->choice.best.cost_s;
  return {"PSF",
          "has its own transform, " + width_and_padding(plan.psf->choice.best) +
              (o.has_w_axis() ? ", " + times(o.facets_l, o.facets_m) + " facets" : ""),
          "to " + text("%.2g", plan.psf->request.accuracy) + " it costs less: " + text("%.2f", apart_s / together_s) +
              " of one transform for both"};
}

/// A plan by gridding and FFTs, with one transform for all images or two, whichever costs less.
GriddingPlan plan_images(const GriddingRequest& request) {
  if (!request.psf) return plan_together(request);
  const double psf_accuracy = request.psf_accuracy == 0 || request.accuracy == 0 ? request.accuracy : request.psf_accuracy;
  GriddingRequest both = request;
  both.accuracy = std::min(request.accuracy, psf_accuracy);
  GriddingPlan together = plan_together(both, psf_accuracy < request.accuracy ? "accuracy of the PSF" : "accuracy");
  together.request = request;
  const double together_s = together.choice.best.cost_s;
  if (psf_accuracy != request.accuracy) {
    GriddingRequest alone = request;
    alone.psf = false;
    GriddingPlan apart = plan_together(alone);
    alone.stokes = 0;
    alone.psf = true;
    alone.accuracy = psf_accuracy;
    alone.best_effort = true;
    apart.psf = std::make_shared<GriddingPlan>(plan_together(alone));
    if (apart.psf->choice.reached && apart.choice.best.cost_s + apart.psf->choice.best.cost_s < together_s) {
      apart.decisions.push_back(psf_decision(apart, together_s));
      apart.request = request;
      return apart;
    }
  }
  together.decisions.push_back(psf_decision(together, together_s));
  return together;
}

}  // namespace

GriddingPlan plan_gridding(const GriddingRequest& request) {
  check_request(request);
  if (request.mosaic) return plan_mosaic(request);
  GriddingPlan plan = plan_images(request);
  const double gridding_s = plan.choice.best.cost_s + (plan.psf ? plan.psf->choice.best.cost_s : 0);
  use_direct_predictions(plan);
  use_direct_images(plan, gridding_s);
  return plan;
}

TransformMemory memory_of(const GriddingPlan& plan) {
  if (plan.windows) return mosaic_memory(plan);
  if (plan.direct) {
    const double image = static_cast<double>(plan.request.geometry.pixels()) * sizeof(double);
    const double samples = static_cast<double>(plan.request.samples), others = plan.request.stokes - 1;
    return {image + 64 * samples, image, 0, others * (image + 16 * samples), 0};
  }
  if (plan.psf) {
    GriddingPlan image = plan;
    image.psf.reset();
    const TransformMemory of_image = memory_of(image), of_psf = memory_of(*plan.psf);
    const double psf =
        plan.psf->options.has_w_axis() ? of_psf.visibilities : of_psf.psf;  // weights alone make one in the plane
    return {of_image.visibilities, psf, std::max(of_image.fft, of_psf.fft), of_image.other_stokes, of_image.gathered};
  }
  const int stokes = std::max(1, plan.request.stokes);
  const auto samples = static_cast<double>(plan.request.samples);
  if (!plan.options.has_w_axis()) return memory_of(static_cast<const CoplanarOptions&>(plan.options), stokes, samples);
  const GriddingCandidate& best = plan.choice.best;
  const std::vector<double>& turns = best.faceting.turns;
  const double most = *std::max_element(turns.begin(), turns.end());
  Faceting largest = best.faceting;
  largest.turns = {most};
  const int planes = largest.planes(best.padding_w, best.work.width_w);
  return memory_of(plan.options, {samples, planes, stokes});
}

}  // namespace misfit::imager
