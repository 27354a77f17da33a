#include "kernels/evaluation.h"

#include <algorithm>
#include <array>
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
  constexpr std::array<const char*, 4> names{"nearest", "linear", "quadratic", "cubic"};
  return std::string(names[static_cast<std::size_t>(options.interpolation)]) +
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

}  // namespace misfit::kernels
