#pragma once

#include <hwy/targets.h>

#include <boost/mpl/list.hpp>
#include <boost/test/unit_test.hpp>
#include <limits>
#include <random>

#include "kernels/piecewise_polynomial.h"

namespace misfit::imager::testing {

using Precisions = boost::mpl::list<float, double>;

inline constexpr int degree = 5;  ///< of the polynomials

/// Makes the loops run with one instruction set while it lives.
class OnlyTarget {
 public:
  explicit OnlyTarget(std::int64_t target) { hwy::SetSupportedTargetsForTest(target); }
  ~OnlyTarget() { hwy::SetSupportedTargetsForTest(0); }
  OnlyTarget(const OnlyTarget&) = delete;
  OnlyTarget& operator=(const OnlyTarget&) = delete;
};

/// Calls test(width) for every width with every instruction set of this machine.
template <typename Test>
void for_each_width_and_target(const Test& test) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const OnlyTarget only(target);
    for (int width = 1; width <= 20; ++width) {
      BOOST_TEST_CONTEXT("target " << hwy::TargetName(target) << " width " << width) {
        test(width);
      }
    }
  }
}

inline kernels::PiecewisePolynomial random_polynomial(int width, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  kernels::PiecewisePolynomial polynomial{Eigen::MatrixXd(degree + 1, width)};
  for (double& coefficient : polynomial.coefficient.reshaped()) coefficient = uniform(random);
  return polynomial;
}

/// No tap exceeds Σ_d 2^−d < 2, so no term exceeds 4; it is rounded once for each of some 2 · degree + 4 operations, and every
/// one of `terms` additions rounds a sum of no more than that.
template <typename Real>
double rounding(int terms) {
  return 4.0 * terms * (2 * degree + 4 + terms) * double{std::numeric_limits<Real>::epsilon()};
}

}  // namespace misfit::imager::testing
