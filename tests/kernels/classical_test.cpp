#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>

#include "kernels/catalogue.h"
#include "tests/kernels/kernels.h"

using namespace misfit::kernels;
using misfit::kernels::testing::normalised;
namespace bdata = boost::unit_test::data;

namespace {

const double pi = std::acos(-1.0);

double sinc(double u) {
  return u == 0 ? 1 : std::sin(pi * u) / (pi * u);
}

Kernel only_kernel(const std::string& name) {
  const KernelFamily family = kernel_family(name);
  BOOST_TEST(family.min_width == family.max_width);
  return family.make(family.min_width, 0.25);
}

/// Largest difference of the stored taps from C(s_r − t), scaled so that h(0) = 1.
double difference(const Kernel& kernel, const std::function<double(double u)>& c) {
  const TapFunction function = normalised([&](double t) {
    return Eigen::VectorXd(Eigen::VectorXd::NullaryExpr(
        kernel.width(), [&](Eigen::Index r) { return c(static_cast<double>(r) - (kernel.width() - 1) / 2.0 - t); }));
  });
  double largest = 0;
  for (const double t : {-0.5, -0.31, 0.0, 0.17, 0.5}) {
    largest = std::max(largest, (kernel.polynomial(t) - function(t)).cwiseAbs().maxCoeff());
  }
  return largest;
}

double map_error_at(const Kernel& kernel, double x) {
  return map_error(kernel.polynomial, Eigen::VectorXd::Constant(1, x))[0];
}

const auto positions = bdata::make({0.0, 0.03, 0.1, 0.25, 0.4, 0.5});
// Taps are stored to an RMS of 1e-10 over the cell; at its ends a truncated series is off by some times that.
constexpr double stored = 1e-9;

}  // namespace

BOOST_AUTO_TEST_SUITE(classical)

BOOST_AUTO_TEST_CASE(each_is_its_formula) {
  BOOST_TEST(difference(only_kernel("nearest"), [](double) { return 1.0; }) < 1e-15);
  BOOST_TEST(difference(only_kernel("linear"), [](double u) { return 1 - std::abs(u); }) < 1e-15);
  BOOST_TEST(difference(only_kernel("sinc"), sinc) < stored);
  BOOST_TEST(difference(only_kernel("gaussian"), [](double u) { return std::exp(-u * u); }) < stored);
  const auto gaussian_sinc = [](double u) { return std::exp(-u * u / (2.52 * 2.52)) * sinc(u / 1.55); };
  BOOST_TEST(difference(only_kernel("gaussian-sinc"), gaussian_sinc) < stored);
}

// ℓ = 1 − c²/Σc(x−n)², and Σ sinc²(x−n) = 1.
BOOST_DATA_TEST_CASE(map_error_of_the_nearest_cell_is_1_minus_sinc_squared, positions, x) {
  BOOST_TEST(std::abs(map_error_at(only_kernel("nearest"), x) - (1 - std::pow(sinc(x), 2))) < 1e-14);
}

// c = sinc², and Σ sinc⁴(x−n) = 1 − ⅔ sin²(πx).
BOOST_DATA_TEST_CASE(map_error_of_linear_interpolation_is_in_closed_form, positions, x) {
  const double power = 1 - 2.0 / 3 * std::pow(std::sin(pi * x), 2);
  BOOST_TEST(std::abs(map_error_at(only_kernel("linear"), x) - (1 - std::pow(sinc(x), 4) / power)) < 1e-14);
}

// c = exp(−π²x²), but for the cut at 4 cells, which is worth exp(−16); the aliases of |n| > 1 are below 1e-9 of c.
BOOST_DATA_TEST_CASE(map_error_of_the_gaussian_is_its_aliases, bdata::make({0.1, 0.2, 0.25, 0.4}), x) {
  const auto power = [](double y) { return std::exp(-2 * pi * pi * y * y); };
  const double alias = power(x - 1) + power(x + 1);
  BOOST_TEST(map_error_at(only_kernel("gaussian"), x) == alias / (power(x) + alias), boost::test_tools::tolerance(1e-2));
}

BOOST_AUTO_TEST_CASE(half_way_to_the_alias_half_of_the_power_is_lost) {
  // Wide kernels have one alias there, as strong as the source.
  for (const std::string name : {"sinc", "gaussian", "gaussian-sinc"})
    BOOST_TEST(map_error_at(only_kernel(name), 0.5) == 0.5, boost::test_tools::tolerance(0.01));
}

BOOST_AUTO_TEST_SUITE_END()
