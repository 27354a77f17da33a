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

BOOST_AUTO_TEST_CASE(the_last_terms_hold_something_where_a_function_bends_inside_a_cell) {
  const auto tent = [](double t) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, 1 - std::abs(t)); };
  const auto tents = [](double t) -> Eigen::VectorXd { return Eigen::Vector2d(0.5 - t, 0.5 + t); };
  BOOST_TEST(part_in_last_terms(fit_polynomial(gaussian_taps, highest_degree)) < 1e-14);
  BOOST_TEST(part_in_last_terms(fit_polynomial(tents, highest_degree)) < 1e-14);
  const PiecewisePolynomial fit = fit_polynomial(tent, highest_degree);
  double missed = 0;
  constexpr int points = 10000;
  for (int i = 0; i < points; ++i) missed += (fit((i + 0.5) / points - 0.5) - tent((i + 0.5) / points - 0.5)).squaredNorm();
  // ∫ (1 − |t|)² dt = 7/12; what is missed is as much as the last terms hold, or somewhat more.
  const double ratio = std::sqrt(missed / points / (7.0 / 12)) / part_in_last_terms(fit);
  BOOST_TEST(ratio > 1);
  BOOST_TEST(ratio < 4);
  BOOST_TEST(part_in_last_terms(fit_polynomial(tent, 20)) == 0);
}

BOOST_AUTO_TEST_CASE(symmetry_of_the_kernel_is_exact) {
  const PiecewisePolynomial fit = fit_polynomial(gaussian_taps, 9);
  for (const double t : {0.1, 0.25, 0.499}) BOOST_TEST((fit(-t) == fit(t).reverse()));
}

BOOST_AUTO_TEST_SUITE_END()
