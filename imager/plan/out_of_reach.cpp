#include "imager/plan/out_of_reach.h"

#include <algorithm>
#include <cmath>

#include "imager/plan/plan_text_internal.h"
#include "kernels/evaluation.h"
#include "kernels/kernel_table.h"

namespace misfit::imager {
namespace {

constexpr double stored = 1e-13;  // below, the rounding of stored kernels differs from width to width

/// The limit of an accuracy, and what would lift it.
struct Limit {
  std::string name;
  std::string expected;  ///< empty where nothing is known to help
};

/// The part that tables have in the worst error.
double table_error(const GriddingCandidate& best) {
  GriddingCandidate exact = best;
  for (AxisKernel* axis : {&exact.u, &exact.v, &exact.w}) axis->misfit = axis->kernel.misfit;
  judge(exact);
  return std::sqrt(std::max(0.0, best.worst_error * best.worst_error - exact.worst_error * exact.worst_error));
}

/// Entries a cell with which tables take half of the accuracy, by the law of fine ones, to two digits.
double entries_needed(const GriddingRequest& request, const GriddingCandidate& best) {
  kernels::TableOptions fine = *request.lookup;
  fine.samples_per_cell = 1024;
  double mean = 0, max = 0;
  for (const AxisKernel* axis : {&best.u, &best.v, &best.w}) {
    if (axis->kernel.width() == 0) continue;
    const kernels::Misfit of_table = kernels::judge_table(axis->kernel.polynomial, {}, fine, axis->kernel.x0);
    mean += of_table.worst_mean;
    max += of_table.max;
  }
  const double order = static_cast<double>(fine.interpolation) + 1;
  const double entries = fine.samples_per_cell * std::pow(std::sqrt(std::max(mean, max)) / (request.accuracy / 2), 1 / order);
  const double digit = std::pow(10, std::floor(std::log10(entries)) - 1);
  return std::ceil(entries / digit) * digit;
}

Limit tables(const GriddingRequest& request, const GriddingCandidate& best) {
  const double entries = entries_needed(request, best);
  const bool possible = entries <= kernels::kernel_table_max_per_cell;
  return {text(*request.lookup),
          (possible ? "--sampling " + text("%.0f", entries) + " or more, or " : "") + "--evaluation polynomial"};
}

Limit precision(const GriddingCandidate& best) {
  if (best.work.precision == Precision::single_precision) return {"single precision", "--precision double or auto"};
  const bool phases = phase_rounding(best.turns) > best.rounding / 2;
  return {"double precision" + (phases ? ", where phases reach " + text("%.2g", best.turns) + " turns" : ""), ""};
}

Limit kernel(const GriddingRequest& request) {
  const bool given = request.kernel_width != 0 || request.padding != 0;
  const std::string usual = GriddingRequest().kernel.name;
  return {"kernel " + request.kernel.name +
              (request.kernel_width == 0 ? "" : " of width " + std::to_string(request.kernel_width)) +
              (request.padding == 0 ? "" : " at padding " + text("%g", request.padding)),
          request.kernel.name != usual ? "--kernel " + usual
          : given                      ? "--kernel-width and --padding left to be chosen"
                                       : ""};
}

Limit limit(const GriddingRequest& request, const GriddingCandidate& best) {
  const double of_tables = request.lookup ? table_error(best) : 0;
  if (of_tables > std::max(best.rounding, best.worst_error / 2)) return tables(request, best);
  // The search ends where a wider kernel would only gather rounding.
  if (best.worst_error < std::max(2 * best.rounding, stored)) return precision(best);
  return kernel(request);
}

/// An accuracy in two digits that will be granted if it is asked for, where `worst_error` is the best that can be had.
double nameable_accuracy(double worst_error) {
  constexpr double two_digits = 1.06;  // may round down by 5%
  return (worst_error < stored ? 2 : two_digits) * worst_error;
}

}  // namespace

std::string out_of_reach(const GriddingRequest& request, const GriddingChoice& choice, const std::string& what) {
  const GriddingCandidate& best = choice.best;
  const Limit limits = limit(request, best);
  return what + " " + text("%g", request.accuracy) + " is out of reach of " + limits.name + "; it can reach " +
         text("%.2g", nameable_accuracy(best.worst_error + choice.borne_phase_rad)) + " for this image, with width " +
         std::to_string(best.work.width) + " at padding " + text("%g", best.padding_u) +
         (limits.expected.empty() ? "" : "; expected " + limits.expected);
}

}  // namespace misfit::imager
