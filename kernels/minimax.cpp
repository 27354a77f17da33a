#include "kernels/minimax.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernels/least_misfit_solver_internal.h"

namespace misfit::kernels {
namespace {

/// ℓ of the solution oscillates about W/2 times in 0 … x0; nodes must see its maxima to a percent.
int kernel_nodes(int width, double x0) {
  return x0 > 0.42 ? 9 * width + 40 : 6 * width + 30;
}

/// Largest ℓ at the nodes over the lower bound.
double above_bound(const MisfitMinimum& minimum) {
  return minimum.error.maxCoeff() / minimum.weighted_error;
}

/// Weights grow by ℓ to a power and keep their mean.
Eigen::VectorXd reweighted(const Eigen::VectorXd& importance, const MisfitMinimum& minimum, const Eigen::VectorXd& weight,
                           double power) {
  constexpr double least = 1e-9;  // a node without any weight would leave h undefined there
  const Eigen::ArrayXd grown = importance.array() * (minimum.error / minimum.weighted_error).array().pow(power);
  const Eigen::VectorXd kept = grown.max(least * grown.maxCoeff());
  return kept / weight.dot(kept);
}

/// A problem and its solution.
struct Weighted {
  MisfitProblem problem;
  MisfitSolution solution;
};

/// Reweights until the largest ℓ is near its bound. Weights need to be right to a percent only, which the narrowest arithmetic
/// gives that can compute E.
Weighted reweight(const MisfitSolution& start, int width, double x0, int& iterations) {
  constexpr double enough = 1.03;  // leaves the rest of the 5% to maxima between nodes and to the stored polynomial
  constexpr int most_rounds = 400;
  constexpr double rounding = 0.1;
  constexpr double largest_power = 0.9;
  constexpr double least_power = 1e-6;  // moves no weight any more
  const int nodes = kernel_nodes(width, x0);
  const Eigen::VectorXd weight = misfit_nodes(nodes, x0).weight;
  Weighted best;
  best.problem = {width, x0, nodes, Eigen::VectorXd::Ones(nodes), start.minimum.log_h, start.minimum.log_h, 1e-5, 1e-5};
  best.solution = minimise_misfit(best.problem, Arithmetic::binary64, rounding);
  double power = largest_power;
  for (int round = 0; round < most_rounds && power > least_power && above_bound(best.solution.minimum) > enough; ++round) {
    Weighted next = best;
    next.problem.last = next.problem.before = best.solution.minimum.log_h;
    next.problem.importance = reweighted(best.problem.importance, best.solution.minimum, weight, power);
    next.solution = minimise_misfit(next.problem, best.solution.arithmetic, rounding);
    iterations += next.solution.minimum.iterations;
    // Every step uphill raises the bound; weights that overshot lower it.
    const bool higher = next.solution.minimum.weighted_error > best.solution.minimum.weighted_error;
    power = higher ? std::min(largest_power, 1.1 * power) : power / 2;
    if (higher) best = next;
  }
  return best;
}

}  // namespace

LeastMisfit solve_minimax(int width, double x0) {
  check_least_misfit_request("minimax", width, x0);
  const MisfitSolution start = least_misfit_solution(width, x0);
  int iterations = start.minimum.iterations;
  Weighted found = reweight(start, width, x0, iterations);
  found.problem.last = found.problem.before = found.solution.minimum.log_h;
  found.problem.step_tolerance = found.problem.error_tolerance = 1e-8;
  const MisfitSolution solution = minimise_misfit(found.problem, start.arithmetic, 1e-5);
  if (!(above_bound(solution.minimum) < 1.05))
    throw std::runtime_error("minimax kernel of width " + std::to_string(width) + " at x0 = " + std::to_string(x0) +
                             ": the best found lies " + std::to_string(above_bound(solution.minimum)) +
                             " times above its lower bound, 1.05 was expected; a wider kernel or a smaller x0 reaches that");
  Origin origin = solution.origin();
  origin.iterations = iterations + solution.minimum.iterations;
  origin.max_error_bound = solution.minimum.weighted_error;
  return {width, x0, origin, solution.minimum.step, solution.minimum.taps};
}

}  // namespace misfit::kernels
