#include "kernels/families/tuned.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "kernels/families/even_taps.h"
#include "kernels/families/spheroidal_exact.h"
#include "tests/kernels/kernels.h"

using namespace misfit::kernels;
using misfit::kernels::testing::normalised;
namespace bdata = boost::unit_test::data;

namespace {

TapFunction kaiser_bessel(int width, double beta) {
  return taps_over_support(
      width, [beta](double eta) { return std::cyl_bessel_i(0, beta * std::sqrt(1 - eta * eta)) / std::cyl_bessel_i(0, beta); });
}

TapFunction exp_semicircle(int width, double beta) {
  return taps_over_support(width, [beta](double eta) { return std::exp(beta * (std::sqrt(1 - eta * eta) - 1)); });
}

TapFunction prolate(int width, double bandwidth) {
  return spheroidal_exact_taps(width, 0, bandwidth);
}

struct Rival {
  std::string name;
  TapsOfParameter taps;
  double tenths_of_least_misfit;  ///< RMS at W = 7, x0 = 0.25 relative to least-misfit's; the project's independent figure
};

std::ostream& operator<<(std::ostream& out, const Rival& rival) {
  return out << rival.name;
}

const auto rivals = bdata::make(
    std::vector<Rival>{{"prolate", prolate, 34}, {"kaiser-bessel", kaiser_bessel, 40}, {"exp-semicircle", exp_semicircle, 64}});

}  // namespace

BOOST_AUTO_TEST_SUITE(tuned)

BOOST_DATA_TEST_CASE(each_is_its_formula_with_the_parameter_it_names, rivals, rival) {
  for (const int width : {2, 5, 8, 13, 20}) {
    const Kernel kernel = kernel_family(rival.name).make(width, 0.25);
    const TapFunction taps = normalised(rival.taps(width, kernel.origin.parameter));
    // 1e-9: stored to 1e-10 in the mean, but for the √ at the edge of the semicircle, up to β exp(−β) √ΔT there.
    const double edge = rival.name == "exp-semicircle" ? std::exp(-kernel.origin.parameter) : 0;
    for (const double t : {-0.5, -0.23, 0.0, 0.37})
      BOOST_TEST((kernel.polynomial(t) - taps(t)).cwiseAbs().maxCoeff() < 1e-9 + edge);
  }
}

BOOST_DATA_TEST_CASE(mean_error_has_a_minimum_at_the_parameter,
                     rivals* bdata::make({0.01, 0.1, 0.25, 0.4, 0.49}) * bdata::make({2, 5, 8, 12}), rival, x0, width) {
  const Kernel kernel = kernel_family(rival.name).make(width, x0);
  if (kernel.origin.mean_error < 1e-26) return;  // rounding
  for (const double factor : {0.98, 0.995, 1.005, 1.02})
    BOOST_TEST(judge(rival.taps(width, factor * kernel.origin.parameter), x0).mean > kernel.origin.mean_error);
}

BOOST_DATA_TEST_CASE(the_minimum_is_the_deepest, rivals* bdata::make({0.01, 0.05, 0.25, 0.45}) * bdata::make({2, 5, 8}), rival,
                     x0, width) {
  const Kernel kernel = kernel_family(rival.name).make(width, x0);
  const double natural = std::acos(-1.0) * width * (1 - x0);
  for (double parameter = 0.2 * natural; parameter < 1.2 * natural; parameter += 0.02 * natural)
    BOOST_TEST(judge(rival.taps(width, parameter), x0).mean > (1 - 1e-6) * kernel.origin.mean_error);
}

BOOST_DATA_TEST_CASE(where_rounding_hides_the_minimum_the_error_is_rounding, rivals* bdata::make({0.05, 0.25}), rival, x0) {
  for (const int width : {16, 18, 20}) {
    const Kernel kernel = kernel_family(rival.name).make(width, x0);
    BOOST_TEST(std::sqrt(kernel.misfit.mean) < 1e-14);  // some tens of units of rounding
  }
}

BOOST_DATA_TEST_CASE(wider_is_better_until_rounding, rivals* bdata::make({0.01, 0.1, 0.25, 0.4}), rival, x0) {
  double narrower = 1;
  for (int width = 2; width <= 20 && narrower > 1e-26; ++width) {
    const double error = kernel_family(rival.name).make(width, x0).origin.mean_error;
    BOOST_TEST(error < narrower);
    narrower = error;
  }
}

BOOST_DATA_TEST_CASE(least_misfit_is_better_by_the_independent_ratio, rivals, rival) {
  const double ratio =
      std::sqrt(kernel_family(rival.name).make(7, 0.25).misfit.mean / kernel_family("least-misfit").make(7, 0.25).misfit.mean);
  BOOST_TEST(std::lround(10 * ratio) == rival.tenths_of_least_misfit);
}

BOOST_AUTO_TEST_SUITE_END()
