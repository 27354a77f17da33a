#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "kernels/least_misfit.h"
#include "kernels/lookup_table.h"
#include "kernels/map_error.h"
#include "kernels/precision.h"

namespace misfit::kernels {

/// A way to evaluate a gridding function. judge(way.taps, x0, way.judging()) gives the errors that it really has.
struct Evaluation {
  std::string name;  ///< as in "cubic table, Ms = 64"
  Precision precision = Precision::double_precision;
  std::size_t bytes = 0;   ///< of the numbers it keeps; 0 where nothing is tabulated
  int steps_per_cell = 0;  ///< see JudgeOptions
  TapFunction taps;
  /// The sum of all taps over the positions, to measure time: it costs no more than the taps.
  std::function<double(const Eigen::VectorXd& t)> total;

  JudgeOptions judging() const { return {steps_per_cell, {}}; }
};

/// Solves for the taps at every t anew, in the arithmetic of the solution. In single precision positions and values are
/// rounded.
Evaluation evaluate_directly(const LeastMisfit& solution, Precision precision);

/// Looks the taps up; see LookupTable.
Evaluation evaluate_by_table(const PiecewisePolynomial& kernel, const TableOptions& options, Precision precision);

/// The errors of a table of a function, with the function's correction; `function` is the function's own misfit over |x| ≤ x0.
/// Tables of up to 512 entries a cell are judged as they are. For finer tables `mean` and `max` follow table_misfit, and
/// `worst` and `worst_mean` are bounds: a table of degree d holds exp(2πitx) up to max |binomial(p, d+1)| (2πx/Ms)^(d+1), and
/// repeats the function's errors at the entries by no more than the sum of the weights' magnitudes.
Misfit judge_table(const PiecewisePolynomial& kernel, const Misfit& function, const TableOptions& options, double x0);

/// Evaluates by Horner's rule. Lower degrees are truncations: fit_polynomial(kernel, degree).
Evaluation evaluate_by_polynomial(const PiecewisePolynomial& kernel, Precision precision);

/// Evaluates by Horner's rule in even and odd halves; see EvenOddPolynomial.
Evaluation evaluate_by_halves(const PiecewisePolynomial& kernel, Precision precision);

}  // namespace misfit::kernels
