#include "kernels/evaluation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "kernels/polynomial_taps.h"

namespace misfit::kernels {
namespace {

constexpr int steps_of_rounding = 64;  // rounding changes from one t to the next: this many steps average it

std::string in_precision(Precision precision) {
  return precision == Precision::single_precision ? ", single" : ", double";
}

/// An Evaluation of anything that writes taps(t, out) in `Real`.
template <typename Real, typename Taps>
Evaluation evaluation_of(Taps written) {
  const auto shared = std::make_shared<const Taps>(std::move(written));
  Evaluation way;
  way.bytes = shared->bytes();
  if (std::is_same_v<Real, float>) {
    way.precision = Precision::single_precision;
    way.steps_per_cell = steps_of_rounding;
  }
  way.taps = [shared](double t) -> Eigen::VectorXd {
    Eigen::Matrix<Real, Eigen::Dynamic, 1> taps(shared->width());
    shared->taps(static_cast<Real>(t), taps.data());
    return taps.template cast<double>();
  };
  way.total = [shared](const Eigen::VectorXd& t) {
    std::vector<Real> taps(static_cast<std::size_t>(shared->width()));
    std::vector<Real> sum(taps.size());
    for (const double at : t) {
      shared->taps(static_cast<Real>(at), taps.data());
      for (std::size_t r = 0; r < taps.size(); ++r) sum[r] += taps[r];
    }
    double total = 0;
    for (const Real part : sum) total += static_cast<double>(part);
    return total;
  };
  return way;
}

template <template <typename> class Taps, typename... Arguments>
Evaluation evaluation_in(Precision precision, const Arguments&... arguments) {
  if (precision == Precision::single_precision) return evaluation_of<float>(Taps<float>(arguments...));
  return evaluation_of<double>(Taps<double>(arguments...));
}

std::string name_of(const TableOptions& options) {
  return std::string(interpolation_names[static_cast<std::size_t>(options.interpolation)]) +
         " table, Ms = " + std::to_string(options.samples_per_cell);
}

}  // namespace

Evaluation evaluate_directly(const LeastMisfit& solution, Precision precision) {
  Evaluation way;
  way.name = "solved for each t" + in_precision(precision);
  way.precision = precision;
  way.taps = solution.taps;
  if (precision == Precision::single_precision) {
    way.steps_per_cell = steps_of_rounding;
    way.taps = [solve = solution.taps](double t) -> Eigen::VectorXd {
      return solve(static_cast<float>(t)).cast<float>().cast<double>();
    };
  }
  way.total = [taps = way.taps](const Eigen::VectorXd& t) {
    double sum = 0;
    for (const double at : t) sum += taps(at).sum();
    return sum;
  };
  return way;
}

Evaluation evaluate_by_table(const PiecewisePolynomial& kernel, const TableOptions& options, Precision precision) {
  Evaluation way = evaluation_in<LookupTable>(precision, kernel, options);
  way.name = name_of(options) + in_precision(precision);
  // Fewer steps than rounding wants become a multiple, which has the table's own steps among its own.
  const int multiple = std::max(1, (way.steps_per_cell + options.samples_per_cell - 1) / options.samples_per_cell);
  way.steps_per_cell = multiple * options.samples_per_cell;
  return way;
}

Evaluation evaluate_by_polynomial(const PiecewisePolynomial& kernel, Precision precision) {
  Evaluation way = evaluation_in<PlainPolynomial>(precision, kernel);
  way.name = "polynomial of degree " + std::to_string(kernel.degree()) + in_precision(precision);
  return way;
}

Evaluation evaluate_by_halves(const PiecewisePolynomial& kernel, Precision precision) {
  Evaluation way = evaluation_in<EvenOddPolynomial>(precision, kernel);
  way.name = "even and odd halves of degree " + std::to_string(kernel.degree()) + in_precision(precision);
  return way;
}

namespace {

Misfit misfit_of_fine_table(const Misfit& function, const TableOptions& options, double x0) {
  // The largest binomial(p, d+1), and the largest sum of the weights' magnitudes, where the table is read.
  constexpr std::array<double, 4> largest{0.5, 1.0 / 8, 0.0641500299, 1.0 / 24};
  constexpr std::array<double, 4> lebesgue{1, 1, 1.25, 1.6311302};
  const auto degree = static_cast<std::size_t>(options.interpolation);
  const int order = static_cast<int>(degree) + 1;
  const double at_edge = std::pow(2 * std::acos(-1.0) * x0 / options.samples_per_cell, order);
  const double over_image = at_edge / std::sqrt(2.0 * order + 1);
  const double rms = interpolation_error_factor(options.interpolation);
  const auto square = [](double x) { return x * x; };
  return {function.mean + square(rms * over_image), function.max + square(rms * at_edge),
          square(lebesgue[degree] * std::sqrt(function.worst_mean) + largest[degree] * over_image),
          square(lebesgue[degree] * std::sqrt(function.worst) + largest[degree] * at_edge)};
}

}  // namespace

Misfit judge_table(const PiecewisePolynomial& kernel, const Misfit& function, const TableOptions& options, double x0) {
  constexpr int fine = 512;
  if (options.samples_per_cell > fine) return misfit_of_fine_table(function, options, x0);
  const Evaluation table = evaluate_by_table(kernel, options, Precision::double_precision);
  return judge(table.taps, x0, {table.steps_per_cell, [&](const Eigen::VectorXd& x) { return optimal_correction(kernel, x); }});
}

}  // namespace misfit::kernels
