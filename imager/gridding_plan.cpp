#include "imager/gridding_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "imager/fft.h"

namespace misfit::imager {
namespace {

/// Relative RMS of taps, sums and FFT, for a noise gain of 1: twice the unit of rounding, as measured.
constexpr double single_rounding = 1.2e-7;
constexpr double double_rounding = 2.2e-16;
constexpr double single_from = 1e-4;  ///< below, sums of millions of samples lose what single precision has left
constexpr int smallest_fft = 64;

std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

/// One way to do it.
struct Candidate {
  double padding = 0;
  int nu = 0;
  int nv = 0;
  kernels::Kernel kernel_u;
  kernels::Kernel kernel_v;
  kernels::Misfit misfit_u{};  ///< over this image's pixels
  kernels::Misfit misfit_v{};
  Precision precision = Precision::double_precision;
  double noise_gain = 1;
  double cost_ns = 0;

  double rounding() const {
    return noise_gain * (precision == Precision::single_precision ? single_rounding : double_rounding);
  }
  /// Of data with random phases.
  double expected_error() const { return std::hypot(std::sqrt(misfit_u.mean + misfit_v.mean), rounding()); }
  /// An image of a single visibility at the worst position of its cell, or the visibilities of a single pixel at the corner.
  double worst_error() const {
    return std::hypot(std::sqrt(std::max(misfit_u.worst_mean + misfit_v.worst_mean, misfit_u.max + misfit_v.max)), rounding());
  }
};

/// Over many pixels the kernel's own means over |x| ≤ x0 serve.
kernels::Misfit misfit_of(const kernels::Kernel& kernel, int pixels, int fft_size) {
  constexpr int continuum = 128;
  return pixels < continuum ? kernels::judge_pixels(kernel.polynomial, pixels, fft_size) : kernel.misfit;
}

/// Time on one core, from counts of operations: constants are of one machine, fixed so that the choice depends on options and
/// data alone. Samples: ordering, polynomials, and three planes of W × padded-W cells; FFTs: half the rows and the kept
/// columns, twice (image and PSF).
double cost_ns(const GriddingRequest& request, int nu, int nv, int width, Precision precision) {
  const double padded = (width + 3) / 4 * 4;
  const double per_sample = 15 + 0.15 * width * padded;
  const double row = nu * std::log2(nu);
  const double column = nv * std::log2(nv);
  const double fft = 2 * (0.5 * nv * row + 0.5 * request.geometry.width * column) * 0.6;
  const double widening = precision == Precision::single_precision ? 1 : 1.5;  // twice the bytes, half the lanes
  return (static_cast<double>(request.samples) * per_sample + fft) * widening;
}

double axis_x0(int pixels, int fft_size, const kernels::KernelFamily& family) {
  return std::clamp(0.5 * pixels / fft_size, family.min_x0, family.max_x0);
}

/// At least four widths, so that a kernel never meets its own periodic copy.
int fft_size(int pixels, int width, double padding, const kernels::KernelFamily& family) {
  const double least = 0.5 / family.max_x0 * (1 - 1e-12);  // x0 came from a padding, and is rounded
  const double needed = std::max(padding, least) * pixels;
  return fast_fft_size(std::max({smallest_fft, 4 * width, static_cast<int>(std::ceil(needed))}));
}

/// The padding asked for, or the usual ones that the family can do with, from the least.
std::vector<double> paddings(const GriddingRequest& request) {
  if (request.padding != 0) return {request.padding};
  const double least = 0.5 / request.kernel.max_x0;
  std::vector<double> found;
  for (const double usual : {1.15, 1.25, 1.4, 1.6, 2.0}) {
    if (usual < least && found.empty()) found.push_back(least);
    if (usual >= least) found.push_back(usual);
  }
  return found;
}

/// One width at one padding, in each precision that may be trusted.
std::vector<Candidate> candidates(const GriddingRequest& request, const kernels::KernelFamily& family, double padding,
                                  int width) {
  const int nu = fft_size(request.geometry.width, width, padding, family);
  const int nv = fft_size(request.geometry.height, width, padding, family);
  const double x0_u = axis_x0(request.geometry.width, nu, family);
  const double x0_v = axis_x0(request.geometry.height, nv, family);
  Candidate candidate{padding, nu, nv, family.make(width, x0_u), {}};
  candidate.kernel_v = x0_v == x0_u ? candidate.kernel_u : family.make(width, x0_v);
  candidate.misfit_u = misfit_of(candidate.kernel_u, request.geometry.width, nu);
  candidate.misfit_v = misfit_of(candidate.kernel_v, request.geometry.height, nv);
  candidate.noise_gain =
      kernels::noise_gain(candidate.kernel_u.polynomial, x0_u) * kernels::noise_gain(candidate.kernel_v.polynomial, x0_v);
  const double wanted = request.accuracy == 0 ? candidate.worst_error() : request.accuracy;
  std::vector<Candidate> found;
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    if (precision == Precision::single_precision && wanted < single_from) continue;
    candidate.precision = precision;
    candidate.cost_ns = cost_ns(request, nu, nv, width, precision);
    found.push_back(candidate);
  }
  return found;
}

/// Narrowest first, until one reaches `target` or wider ones would only gather rounding.
std::vector<Candidate> widths_at(const GriddingRequest& request, const kernels::KernelFamily& family, double padding,
                                 double target) {
  std::vector<Candidate> found;
  const int first = request.kernel_width == 0 ? family.min_width : request.kernel_width;
  const int last = request.kernel_width == 0 ? family.max_width : request.kernel_width;
  for (int width = first; width <= last; ++width)
    for (const Candidate& candidate : candidates(request, family, padding, width)) {
      found.push_back(candidate);
      const bool precise = candidate.precision == Precision::double_precision;
      if (candidate.worst_error() <= target || (precise && candidate.worst_error() < 2 * candidate.rounding())) return found;
    }
  return found;
}

struct Choice {
  std::optional<Candidate> cheapest;  ///< of those that reach the accuracy
  std::optional<Candidate> most_exact;
  std::string rejected;  ///< cheapest of each other padding
};

Choice choose(const GriddingRequest& request, const kernels::KernelFamily& family) {
  const double target = request.accuracy == 0 ? HUGE_VAL : request.accuracy;
  Choice choice;
  std::vector<Candidate> reaching;
  for (const double padding : paddings(request)) {
    for (const Candidate& candidate : widths_at(request, family, padding, target)) {
      if (!choice.most_exact || candidate.worst_error() < choice.most_exact->worst_error()) choice.most_exact = candidate;
      if (candidate.worst_error() > target) continue;
      reaching.push_back(candidate);
      if (!choice.cheapest || candidate.cost_ns < choice.cheapest->cost_ns) choice.cheapest = candidate;
      break;  // a wider kernel at the same padding only costs more
    }
  }
  for (const Candidate& candidate : reaching)
    if (candidate.padding != choice.cheapest->padding)
      choice.rejected += (choice.rejected.empty() ? "" : ", ") + std::string("width ") +
                         std::to_string(candidate.kernel_u.width()) + " at padding " + text("%.2f", candidate.padding) +
                         " costs " + text("%.2f×", candidate.cost_ns / choice.cheapest->cost_ns);
  return choice;
}

Plan decisions_of(const GriddingRequest& request, const GriddingPlan& plan, const std::string& rejected) {
  const PlaneTransformOptions& o = plan.options;
  const bool single = o.precision == Precision::single_precision;
  const std::string because_accuracy = request.accuracy == 0 ? "as asked"
                                                             : "worst position within a cell, or pixel at the corner, gives " +
                                                                   text("%.2g", plan.worst_error) + ", accuracy asked " +
                                                                   text("%.2g", request.accuracy);
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
              : "single precision would add " + text("%.1g", plan.rounding * single_rounding / double_rounding) +
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

GriddingPlan plan_gridding(const GriddingRequest& request) {
  check_request(request);
  const kernels::KernelFamily& family = request.kernel;
  const Choice choice = choose(request, family);
  if (!choice.cheapest && !request.best_effort)  // 1.06: two digits may round down by 5%
    throw std::invalid_argument("accuracy " + text("%g", request.accuracy) + " is out of reach of kernel " + family.name +
                                (request.kernel_width == 0 ? "" : " of width " + std::to_string(request.kernel_width)) +
                                (request.padding == 0 ? "" : " at padding " + text("%g", request.padding)) + "; it can reach " +
                                text("%.2g", 1.06 * choice.most_exact->worst_error()) + " for this image, with width " +
                                std::to_string(choice.most_exact->kernel_u.width()) + " at padding " +
                                text("%g", choice.most_exact->padding));
  const Candidate& best = choice.cheapest ? *choice.cheapest : *choice.most_exact;
  GriddingPlan plan;
  plan.options.geometry = request.geometry;
  plan.options.nu = best.nu;
  plan.options.nv = best.nv;
  plan.options.kernel_u = best.kernel_u;
  plan.options.kernel_v = best.kernel_v;
  plan.options.precision = best.precision;
  plan.options.threads = request.threads;
  plan.expected_error = best.expected_error();
  plan.rounding = best.rounding();
  plan.worst_error = best.worst_error();
  constexpr double several = 6;  // rounding is random; six times its RMS bounds it for practical purposes
  plan.bound_rms =
      (1 + std::sqrt(best.misfit_u.worst_mean)) * (1 + std::sqrt(best.misfit_v.worst_mean)) - 1 + several * plan.rounding;
  plan.bound_max = (1 + std::sqrt(best.misfit_u.worst)) * (1 + std::sqrt(best.misfit_v.worst)) - 1 + several * plan.rounding;
  plan.decisions = decisions_of(request, plan, choice.rejected);
  return plan;
}

}  // namespace misfit::imager
