#include "kernels/families/spheroidal_exact.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "kernels/catalogue.h"
#include "kernels/families/spheroidal.h"
#include "kernels/quadrature.h"
#include "tests/kernels/kernels.h"

using namespace misfit::kernels;
using misfit::kernels::testing::normalised;
namespace bdata = boost::unit_test::data;

namespace {

const double pi = std::acos(-1.0);

/// (1 − η²)^α ψ(η) and a rule for its integrals over 0 ≤ η ≤ 1 in the angle η = sin θ, in which it is smooth for every half of
/// a whole number α.
struct Sampled {
  Eigen::ArrayXd eta;
  Eigen::ArrayXd value;
  Eigen::ArrayXd weight;

  Sampled(double alpha, double bandwidth) {
    const Quadrature angle = gauss_legendre(100, 0, pi / 2);
    eta = angle.node.array().sin();
    weight = angle.weight.array() * angle.node.array().cos();
    const TapFunction taps = spheroidal_exact_taps(1, alpha, bandwidth);
    value = eta;
    for (double& v : value) v = taps(v / 2)[0];
  }
  double integral(const Eigen::ArrayXd& other) const { return (weight * value * other).sum(); }
};

const auto orders = bdata::make({0.0, 0.5, 1.0, 1.5, 2.0, 4.5, 10.0});
const auto bandwidths = bdata::make({0.3, 2.0, pi / 2, 3 * pi, 7 * pi / 2, 10 * pi, 60.0, 200.0});
// Eigenvectors are good to the unit of rounding times the norm of the matrix, some 1e4, over the distance of eigenvalues,
// some 10.
constexpr double rounding = 1e-12;

}  // namespace

BOOST_AUTO_TEST_SUITE(spheroidal_exact)

// With ψ(0) = 1 the eigenvalue is the integral of the function itself.
BOOST_DATA_TEST_CASE(is_an_eigenfunction_of_the_finite_fourier_transform, orders* bandwidths, alpha, bandwidth) {
  const Sampled function(alpha, bandwidth);
  const double eigenvalue = function.integral(Eigen::ArrayXd::Ones(function.eta.size()));
  for (Eigen::Index i = 0; i < function.eta.size(); i += 7) {
    const double eta = function.eta[i];
    const double transformed = std::pow(1 - eta * eta, alpha) * function.integral((bandwidth * eta * function.eta).cos());
    BOOST_TEST(std::abs(transformed / eigenvalue - function.value[i]) < rounding);
  }
}

// Integrated against η^2j, both derivatives moved there: the equation's operator is self-adjoint with the weight (1 − η²)^α.
BOOST_DATA_TEST_CASE(solves_the_differential_equation, orders* bandwidths, alpha, bandwidth) {
  const Sampled function(alpha, bandwidth);
  const Eigen::ArrayXd square = function.eta.square();
  const double c_square = bandwidth * bandwidth;
  const double b = c_square * function.integral(square) / function.integral(Eigen::ArrayXd::Ones(square.size()));
  for (int j = 1; j <= 8; ++j) {
    const Eigen::ArrayXd second = 2 * j * (2 * j - 1) * (1 - square) * square.pow(j - 1);
    const Eigen::ArrayXd first = 2 * (alpha + 1) * 2 * j * square.pow(j);
    const Eigen::ArrayXd against = second - first + (b - c_square * square) * square.pow(j);
    BOOST_TEST(std::abs(function.integral(against)) < rounding * (function.weight * against.abs()).sum());
  }
}

BOOST_DATA_TEST_CASE(has_no_zero_and_falls, orders* bandwidths, alpha, bandwidth) {
  const Sampled function(alpha, bandwidth);
  for (Eigen::Index i = 1; i < function.eta.size(); ++i) {
    BOOST_TEST(function.value[i] > -rounding);
    BOOST_TEST(function.value[i] < function.value[i - 1] + rounding);
  }
}

BOOST_DATA_TEST_CASE(schwabs_approximation_agrees, bdata::xrange(4, 9) * bdata::make({0.0, 0.5, 1.0, 1.5, 2.0}), m, alpha) {
  const TapFunction approximation = spheroidal_taps(m, alpha);
  const TapFunction exact = spheroidal_exact_taps(m, alpha, pi * m / 2);
  for (int i = -20; i <= 20; ++i)  // 5e-6: spheroidal_test.cpp
    BOOST_TEST((approximation(i / 40.0) - exact(i / 40.0)).cwiseAbs().maxCoeff() < 5e-6);
}

BOOST_DATA_TEST_CASE(without_bandwidth_only_the_weight_is_left, bdata::make({0.0, 0.3, 1.0, 2.5}), alpha) {
  const Eigen::VectorXd taps = spheroidal_exact_taps(4, alpha, 0)(0.1);
  for (int r = 0; r < 4; ++r)
    BOOST_TEST(taps[r] == std::pow(1 - std::pow((r - 1.6) / 2, 2), alpha), boost::test_tools::tolerance(1e-13));
}

BOOST_AUTO_TEST_CASE(a_wide_band_tends_to_the_gaussian) {
  // ψ → exp(−cη²/2) for c → ∞, with corrections of the order of 1/c.
  const double c = 200;
  const TapFunction taps = spheroidal_exact_taps(1, 0, c);
  for (const double eta : {0.02, 0.05, 0.1})
    BOOST_TEST(taps(eta / 2)[0] == std::exp(-c * eta * eta / 2), boost::test_tools::tolerance(2 / c));
}

BOOST_AUTO_TEST_CASE(any_order_from_0_to_10_is_a_family_by_name) {
  for (const std::string order : {"0", "0.5", "1", "2.75", "10", "1e-1"}) {
    const Kernel kernel = kernel_family("spheroidal-exact-" + order).make(6, 0.25);
    BOOST_TEST(kernel.name == "spheroidal-exact-" + order);
    const TapFunction taps = normalised(spheroidal_exact_taps(6, std::stod(order), 3 * pi));
    BOOST_TEST((kernel.polynomial(0.2) - taps(0.2)).cwiseAbs().maxCoeff() < 1e-5);  // √ at the edge of order 0.1
  }
  const Kernel usual = kernel_family("spheroidal-exact").make(6, 0.25);
  BOOST_TEST((usual.polynomial.coefficient == kernel_family("spheroidal-exact-1").make(6, 0.25).polynomial.coefficient));
}

BOOST_AUTO_TEST_CASE(what_is_no_order_is_refused_by_name) {
  for (const std::string order : {"", "x", "0.5x", " 1", "-1", "10.1", "nan", "inf", "1e999"})
    BOOST_CHECK_EXCEPTION(
        kernel_family("spheroidal-exact-" + order), std::invalid_argument, [&](const std::invalid_argument& e) {
          return e.what() == "kernel \"spheroidal-exact-" + order + "\": order \"" + order + "\" is not a number in [0, 10]";
        });
}

BOOST_AUTO_TEST_CASE(arguments_out_of_range_are_refused) {
  BOOST_CHECK_THROW(spheroidal_exact_taps(0, 1, 5), std::invalid_argument);
  for (const double alpha : {-0.1, 10.1, std::nan("")})
    BOOST_CHECK_THROW(spheroidal_exact_taps(6, alpha, 5), std::invalid_argument);
  for (const double c : {-0.1, 200.1, std::nan("")}) BOOST_CHECK_THROW(spheroidal_exact_taps(6, 1, c), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
