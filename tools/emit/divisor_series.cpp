#include "tools/emit/divisor_series.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace misfit::tools {

double DivisorSeries::operator()(double x) const {
  const double part = std::min(std::abs(x) / x0, 1.0);
  const double y = 2 * part * part - 1;
  double next = 0, after = 0;
  for (Eigen::Index k = coefficient.size() - 1; k > 0; --k) {
    const double sum = coefficient[k] + 2 * y * next - after;
    after = next;
    next = sum;
  }
  return coefficient[0] + y * next - after;
}

DivisorSeries divisor_series(const kernels::Correction& h, double x0) {
  constexpr int terms = 48;
  const Eigen::ArrayXd angle = (Eigen::ArrayXd::LinSpaced(terms, 0, terms - 1) + 0.5) * std::numbers::pi / terms;
  const Eigen::VectorXd x = x0 * (angle / 2).cos();  // y = cos(angle) = 2(x/x0)² − 1
  const Eigen::VectorXd value = h(x).cwiseInverse();
  Eigen::VectorXd coefficient(terms);
  for (int k = 0; k < terms; ++k) coefficient[k] = (k == 0 ? 1.0 : 2.0) / terms * value.dot((k * angle).cos().matrix());
  const double least = 1e-14 * value.cwiseAbs().maxCoeff();
  Eigen::Index count = terms;
  while (count > 1 && std::abs(coefficient[count - 1]) < least) --count;
  return {x0, coefficient.head(count)};
}

}  // namespace misfit::tools
