#include "kernels/cheapest_polynomial.h"

#include <algorithm>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "kernels/catalogue.h"

using namespace misfit::kernels;
namespace bdata = boost::unit_test::data;

namespace {

int degree_for_one_percent(int width) {
  if (width <= 4) return width + 1;
  if (width <= 9) return width;
  return width <= 13 ? width - 1 : width - 2;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cheapest_polynomial)

BOOST_DATA_TEST_CASE(errors_by_degree_are_those_that_judging_finds, bdata::make({0.1, 0.25, 0.45}), x0) {
  for (const KernelFamily& family : kernel_catalogue()) {
    const Kernel kernel = family.make(std::clamp(6, family.min_width, family.max_width), x0);
    const Eigen::VectorXd error = mean_error_by_degree(kernel);
    BOOST_TEST(error.size() == kernel.polynomial.degree() + 1);
    for (int degree = 0; degree < error.size(); ++degree) {
      const double judged = judge(fit_polynomial(kernel.polynomial, degree), x0).mean;
      // Rounding, 1e-16, against the square root of E: 1e-9 at x0 = 0.1.
      BOOST_TEST(error[degree] == judged, boost::test_tools::tolerance(1e-6));
    }
  }
}

BOOST_DATA_TEST_CASE(the_degree_is_the_lowest_that_is_allowed, bdata::xrange(1, 12) * bdata::make({0.005, 0.3, 100.0}), width,
                     allowed) {
  const Kernel kernel = kernel_family("least-misfit").make(width, 0.25);
  const PiecewisePolynomial cheapest = misfit::kernels::cheapest_polynomial(kernel, allowed);
  // 1e-6: rounding and the difference of two quadratures.
  BOOST_TEST(judge(cheapest, 0.25).mean <= (1 + allowed + 1e-6) * kernel.misfit.mean);
  if (cheapest.degree() == 0) return;
  const PiecewisePolynomial lower = fit_polynomial(kernel.polynomial, cheapest.degree() - 1);
  BOOST_TEST(judge(lower, 0.25).mean > (1 + allowed - 1e-6) * kernel.misfit.mean);
}

BOOST_DATA_TEST_CASE(degrees_near_the_width_cost_less_than_a_percent, bdata::xrange(1, 17), width) {
  const Kernel kernel = kernel_family("least-misfit").make(width, 0.25);
  BOOST_TEST(misfit::kernels::cheapest_polynomial(kernel, 0.01).degree() <= degree_for_one_percent(width));
}

BOOST_AUTO_TEST_CASE(nothing_allowed_keeps_the_stored_polynomial) {
  const Kernel kernel = kernel_family("least-misfit").make(5, 0.25);
  BOOST_TEST((misfit::kernels::cheapest_polynomial(kernel, 0).coefficient == kernel.polynomial.coefficient));
}

BOOST_AUTO_TEST_SUITE_END()
