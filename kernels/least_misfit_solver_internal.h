#pragma once

#include <Eigen/Core>
#include <string>

#include "kernels/kernel.h"

namespace misfit::kernels {

/// log h as a series in T_2j(θ/θ0), where sin θ = 2x and θ0 belongs to x0: smooth even when it is rounded. In terms that every
/// arithmetic understands: [j][part], each coefficient the sum of its parts, largest first. Empty for h = 1.
using LogCorrection = Eigen::MatrixXd;

/// The start and the goal of the search for h.
struct MisfitProblem {
  int width = 0;
  double x0 = 0;
  int nodes = 0;               ///< in x
  Eigen::VectorXd importance;  ///< at the nodes; ℓ is weighted with it over x. Its mean over |x| ≤ x0 is 1
  LogCorrection last;          ///< of width W − 1 …
  LogCorrection before;        ///< … and W − 2; the search starts from h²_{W−1} / h_{W−2}
  double step_tolerance = 0;   ///< relative: the search ends when a step would change h by less …
  double error_tolerance = 0;  ///< … and the mean by less, relative
};

/// Minimum of E(h) = mean of importance·ℓ at the best C for every h.
struct MisfitMinimum {
  LogCorrection log_h;        ///< h = 1 at x = 0
  Eigen::VectorXd error;      ///< ℓ at the nodes
  double mean_error = 0;      ///< mean of ℓ
  double weighted_error = 0;  ///< mean of importance·ℓ: what was minimised
  double h_range = 1;         ///< largest h over the smallest
  double rounding = 0;        ///< estimate of the relative rounding error of both means
  double step = 0;            ///< relative size of the last step in h
  double condition = 0;       ///< of the normal equations for C, in the 2-norm
  int iterations = 0;
  TapFunction taps;
};

/// The arithmetics, narrowest first.
enum class Arithmetic { binary64, binary128, binary256 };

/// x at the nodes and weights of the mean over |x| ≤ x0, by the Gauss–Lobatto rule in θ: h has its singularity at x = ½, which
/// this moves away from the nodes when x0 comes near. The first node is x0, the last 0.
struct MisfitNodes {
  Eigen::VectorXd x;
  Eigen::VectorXd weight;
};
MisfitNodes misfit_nodes(int nodes, double x0);

/// Each throws std::runtime_error when the iteration does not converge.
MisfitMinimum minimise_misfit_in_double(const MisfitProblem& problem);
MisfitMinimum minimise_misfit_in_quadruple(const MisfitProblem& problem);
MisfitMinimum minimise_misfit_in_256_bits(const MisfitProblem& problem);

/// A minimum and the arithmetic that it took.
struct MisfitSolution {
  MisfitMinimum minimum;
  Arithmetic arithmetic = Arithmetic::binary64;

  Origin origin() const;
};

/// Solves in the arithmetic given, or in the first wider one whose rounding leaves E right to `rounding` of itself and h to a
/// hundred times the problem's step.
MisfitSolution minimise_misfit(const MisfitProblem& problem, Arithmetic arithmetic, double rounding);

/// Throws std::invalid_argument that names the kernel when the width or x0 lie outside what can be solved.
void check_least_misfit_request(const std::string& name, int width, double x0);

/// The least-misfit function: widths 1 … `width` in turn, since each solution starts the next.
MisfitSolution least_misfit_solution(int width, double x0);

}  // namespace misfit::kernels
