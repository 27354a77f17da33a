#include "kernels/piecewise_polynomial.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

using namespace misfit::kernels;

namespace {

/// C(u) = exp(−u²/2) on five cells.
Eigen::VectorXd gaussian_taps(double t) {
  Eigen::VectorXd taps(5);
  for (int r = 0; r < 5; ++r) taps[r] = std::exp(-0.5 * (r - 2 - t) * (r - 2 - t));
  return taps;
}

double largest_difference(const PiecewisePolynomial& polynomial) {
  double largest = 0;
  for (int i = 0; i <= 100; ++i) {
    const double t = i / 100.0 - 0.5;
    largest = std::max(largest, (polynomial(t) - gaussian_taps(t)).cwiseAbs().maxCoeff());
  }
  return largest;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(piecewise_polynomial)

BOOST_AUTO_TEST_CASE(fit_of_a_smooth_function_converges_to_rounding) {
  BOOST_TEST(largest_difference(fit_polynomial(gaussian_taps, 3)) < 2e-3);
  BOOST_TEST(largest_difference(fit_polynomial(gaussian_taps, 6)) < 1e-6);
  BOOST_TEST(largest_difference(fit_polynomial(gaussian_taps, 12)) <
             1e-12);  // powers of t amplify the rounding of the 12th Legendre term
}

BOOST_AUTO_TEST_CASE(fit_reproduces_polynomials_exactly) {
  const auto cubic = [](double t) -> Eigen::VectorXd {
    Eigen::VectorXd taps(2);
    taps << 1 + t - 2 * t * t + 3 * t * t * t, 1 - t - 2 * t * t - 3 * t * t * t;
    return taps;
  };
  const PiecewisePolynomial fit = fit_polynomial(cubic, 5);
  for (const double t : {-0.5, -0.2, 0.0, 0.31, 0.5}) BOOST_TEST((fit(t) - cubic(t)).norm() < 1e-14);
}

BOOST_AUTO_TEST_CASE(symmetry_of_the_kernel_is_exact) {
  const PiecewisePolynomial fit = fit_polynomial(gaussian_taps, 9);
  for (const double t : {0.1, 0.25, 0.499}) BOOST_TEST((fit(-t) == fit(t).reverse()));
}

BOOST_AUTO_TEST_SUITE_END()
