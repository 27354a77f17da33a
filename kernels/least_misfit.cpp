#include "kernels/least_misfit.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include "kernels/least_misfit_solver_internal.h"

namespace misfit::kernels {
namespace {

struct ArithmeticFacts {
  Arithmetic arithmetic;
  const char* name;
  double epsilon;
  MisfitMinimum (*minimise)(const MisfitProblem&);
};

const std::array<ArithmeticFacts, 3> arithmetics{{{Arithmetic::binary64, "double", 0x1p-52, minimise_misfit_in_double},
                                                  {Arithmetic::binary128, "quadruple", 0x1p-112, minimise_misfit_in_quadruple},
                                                  {Arithmetic::binary256, "256 bits", 0x1p-255, minimise_misfit_in_256_bits}}};

constexpr double rounding_of_a_start = 1e-2;
constexpr double rounding_of_a_result = 1e-6;

/// So many nodes that E is right to 1e-8 of itself for all widths and x0; x0 towards ½ is the hardest.
int nodes_for(int width, double x0) {
  return width + width / 2 + (x0 > 0.42 ? 22 : 14);
}

/// The narrowest arithmetic that is expected to keep the rounding of E; compare MisfitMinimum::rounding.
Arithmetic arithmetic_for(double mean_error, double h_range, double rounding) {
  for (const ArithmeticFacts& facts : arithmetics)
    if (facts.epsilon * h_range / std::sqrt(mean_error) <= rounding) return facts.arithmetic;
  return arithmetics.back().arithmetic;
}

}  // namespace

Origin MisfitSolution::origin() const {
  Origin origin;
  origin.mean_error = minimum.mean_error;
  origin.max_error = minimum.error.maxCoeff();
  origin.condition = minimum.condition;
  origin.iterations = minimum.iterations;
  origin.precision = arithmetics[static_cast<std::size_t>(arithmetic)].name;
  return origin;
}

MisfitSolution minimise_misfit(const MisfitProblem& problem, Arithmetic arithmetic, double rounding) {
  for (auto i = static_cast<std::size_t>(arithmetic); i < arithmetics.size(); ++i) {
    const bool widest = i + 1 == arithmetics.size();
    try {
      const MisfitMinimum minimum = arithmetics[i].minimise(problem);
      const bool stalled_early = minimum.step > 100 * problem.step_tolerance;
      if ((minimum.rounding <= rounding && !stalled_early) || widest) return {minimum, arithmetics[i].arithmetic};
    } catch (const std::runtime_error&) {
      if (widest) throw;
    }
  }
  throw std::logic_error("no arithmetic");
}

MisfitSolution least_misfit_solution(int width, double x0) {
  MisfitSolution last;
  MisfitSolution before;
  for (int w = 1; w <= width; ++w) {
    const int nodes = nodes_for(w, x0);
    const MisfitProblem problem{w,
                                x0,
                                nodes,
                                Eigen::VectorXd::Ones(nodes),
                                last.minimum.log_h,
                                w == 2 ? last.minimum.log_h : before.minimum.log_h,
                                w == width ? 1e-6 : 1e-3,
                                1e-2};
    Arithmetic arithmetic = Arithmetic::binary64;
    if (w > 2) {
      const double ratio = last.minimum.mean_error / before.minimum.mean_error;
      arithmetic = arithmetic_for(last.minimum.mean_error * ratio, last.minimum.h_range, rounding_of_a_start);
    }
    before = last;
    last = minimise_misfit(problem, arithmetic, rounding_of_a_start);
  }
  // A step that the start already allows is not asked of the wider arithmetic again.
  const int nodes = nodes_for(width, x0);
  const MisfitProblem problem{width, x0,  nodes, Eigen::VectorXd::Ones(nodes), last.minimum.log_h, last.minimum.log_h,
                              1e-10, 1e-8};
  MisfitSolution found = minimise_misfit(
      problem, arithmetic_for(last.minimum.mean_error, last.minimum.h_range, rounding_of_a_result), rounding_of_a_result);
  found.minimum.iterations += last.minimum.iterations;
  return found;
}

void check_least_misfit_request(const std::string& name, int width, double x0) {
  if (width < 1 || width > least_misfit_max_width)
    throw std::invalid_argument("kernel " + name + ": width " + std::to_string(width) + ", expected 1 to " +
                                std::to_string(least_misfit_max_width));
  if (!(x0 >= least_misfit_min_x0 && x0 <= least_misfit_max_x0))
    throw std::invalid_argument("kernel " + name + ": x0 = " + std::to_string(x0) + ", expected 0.01 to 0.49");
}

LeastMisfit solve_least_misfit(int width, double x0) {
  check_least_misfit_request("least-misfit", width, x0);
  const MisfitSolution solution = least_misfit_solution(width, x0);
  return {width, x0, solution.origin(), solution.minimum.step, solution.minimum.taps};
}

}  // namespace misfit::kernels
