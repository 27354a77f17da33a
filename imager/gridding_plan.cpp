#include "imager/gridding_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace misfit::imager {
namespace {

std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

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

Plan decisions_of(const GriddingRequest& request, const GriddingPlan& plan) {
  const PlaneTransformOptions& o = plan.options;
  const bool single = o.precision == Precision::single_precision;
  const std::string because_accuracy = request.accuracy == 0 ? "as asked"
                                                             : "worst position within a cell, or pixel at the corner, gives " +
                                                                   text("%.2g", plan.worst_error) + ", accuracy asked " +
                                                                   text("%.2g", request.accuracy);
  const std::string rejected = text_of(plan.choice);
  const std::string others = rejected.empty() ? "" : "; " + rejected;
  return {
      {"kernel", o.kernel_u.name, "expected error of random data " + text("%.2g", plan.expected_error)},
      {"kernel width", std::to_string(o.kernel_u.width()), because_accuracy},
      {"FFT size", std::to_string(o.nu) + " × " + std::to_string(o.nv),
       "padding " + text("%.3f", static_cast<double>(o.nu) / o.geometry.width) +
           " along u is the cheapest that keeps the accuracy" + others},
      {"kernel evaluation", "polynomials of degree " + std::to_string(o.kernel_u.polynomial.degree()),
       "adds less than 0.5% to the kernel's squared error"},
      {"precision of grid and FFT", single ? "single" : "double",
       single ? "rounding adds " + text("%.1g", plan.rounding)
              : "single precision would add " + text("%.1g", plan.rounding * single_over_double) +
                    " of rounding, and is not trusted below " + text("%.0e", single_from)},
      {"half of the uv plane", "gridded alone",
       "the image is real, so V(−u, −v) = conj V(u, v): half the memory, half the FFT"},
  };
}

}  // namespace

void check_request(const GriddingRequest& request) {
  const kernels::KernelFamily& family = request.kernel;
  if (request.kernel_width != 0 && (request.kernel_width < family.min_width || request.kernel_width > family.max_width))
    throw std::invalid_argument("kernel width " + std::to_string(request.kernel_width) + " not in [" +
                                std::to_string(family.min_width) + ", " + std::to_string(family.max_width) +
                                "], which kernel " + family.name + " offers");
  if (request.padding != 0 && !(request.padding >= 1.02 && request.padding <= 10))
    throw std::invalid_argument("padding " + text("%g", request.padding) + " not in [1.02, 10]");
  constexpr double typed = 1e-3;  // what a padding of four digits may be off by
  if (request.padding != 0 && request.padding < (1 - typed) * 0.5 / family.max_x0)
    throw std::invalid_argument("padding " + text("%g", request.padding) + " is less than " +
                                text("%.4g", 0.5 / family.max_x0) + ", which kernel " + family.name +
                                " needs, made for x0 up to " + text("%.4g", family.max_x0));
  if (!(request.accuracy >= 0 && request.accuracy < 1))
    throw std::invalid_argument("accuracy " + text("%g", request.accuracy) + " not in (0, 1)");
}

double nameable_accuracy(double worst_error) {
  constexpr double two_digits = 1.06;  // may round down by 5%
  constexpr double stored = 1e-13;     // below, the rounding of stored kernels differs from width to width
  return (worst_error < stored ? 2 : two_digits) * worst_error;
}

GriddingPlan plan_gridding(const GriddingRequest& request) {
  check_request(request);
  if (request.w_turns != 0)
    throw std::invalid_argument("w_turns is " + text("%g", request.w_turns) +
                                ", expected 0: the plane transform has no w axis");
  GriddingPlan plan;
  plan.choice = choose_gridding(request);
  const GriddingCandidate& best = plan.choice.best;
  if (!plan.choice.reached && !request.best_effort)
    throw std::invalid_argument("accuracy " + text("%g", request.accuracy) + " is out of reach of kernel " +
                                request.kernel.name +
                                (request.kernel_width == 0 ? "" : " of width " + std::to_string(request.kernel_width)) +
                                (request.padding == 0 ? "" : " at padding " + text("%g", request.padding)) + "; it can reach " +
                                text("%.2g", nameable_accuracy(best.worst_error)) + " for this image, with width " +
                                std::to_string(best.work.width) + " at padding " + text("%g", best.padding_u));
  plan.options = {request.geometry, best.work.nu,        best.work.nv,   best.u.kernel,
                  best.v.kernel,    best.work.precision, request.threads};
  plan.expected_error = best.expected_error;
  plan.rounding = best.rounding;
  plan.worst_error = best.worst_error;
  constexpr double several = 6;     // rounding is random; six times its RMS bounds it for practical purposes
  constexpr double between = 1.01;  // maxima were looked for at points, and lie between them
  const auto both = [](double u, double v) { return (1 + between * std::sqrt(u)) * (1 + between * std::sqrt(v)) - 1; };
  plan.bound_rms = both(best.u.misfit.worst_mean, best.v.misfit.worst_mean) + several * plan.rounding;
  plan.bound_max = both(best.u.misfit.worst, best.v.misfit.worst) + several * plan.rounding;
  plan.decisions = decisions_of(request, plan);
  return plan;
}

}  // namespace misfit::imager
