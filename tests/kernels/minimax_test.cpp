#include "kernels/minimax.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

using namespace misfit::kernels;
namespace bdata = boost::unit_test::data;

namespace {

/// Largest ℓ of the stored kernel on a grid that misses a maximum by less than 0.1%.
double largest_error(const Kernel& kernel) {
  return map_error(kernel.polynomial, Eigen::VectorXd::LinSpaced(2001, 0, kernel.x0)).maxCoeff();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(minimax)

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(the_largest_error_is_within_five_percent_of_what_any_kernel_can_reach,
                     bdata::make({1, 2, 3, 5, 8}) * bdata::make({0.1, 0.25, 0.4, 0.47}), width, x0) {
  const Kernel kernel = store("minimax", solve_minimax(width, x0));
  if (kernel.origin.max_error < 1e-25) return;  // the stored doubles' own rounding shows
  BOOST_TEST(largest_error(kernel) < 1.05 * kernel.origin.max_error_bound);
  BOOST_TEST(kernel.origin.max_error_bound < largest_error(kernel));
}

BOOST_DATA_TEST_CASE(least_misfit_and_minimax_each_win_in_their_own_norm, bdata::make({2, 4, 6, 8}) * bdata::make({0.2, 0.35}),
                     width, x0) {
  const Kernel mean = store("least-misfit", solve_least_misfit(width, x0));
  const Kernel largest = store("minimax", solve_minimax(width, x0));
  BOOST_TEST(largest_error(largest) < largest_error(mean));
  BOOST_TEST(mean.misfit.mean < largest.misfit.mean);
  // The bound binds every kernel, the least-misfit among them.
  BOOST_TEST(largest.origin.max_error_bound < largest_error(mean));
}

BOOST_AUTO_TEST_CASE(width_7_at_a_quarter_reaches_the_known_limit) {
  // The project's independent figures: 0.098 of the least-misfit's largest ℓ, no kernel below 2.7e-14.
  const LeastMisfit solved = solve_minimax(7, 0.25);
  BOOST_TEST(solved.origin.max_error < 2.95e-14);
  BOOST_TEST(solved.origin.max_error_bound > 2.7e-14);
  BOOST_TEST(solved.origin.mean_error < 1.5 * 1.4543933e-14);
}

BOOST_AUTO_TEST_CASE(requests_that_cannot_be_met_are_refused) {
  BOOST_CHECK_THROW(solve_minimax(0, 0.25), std::invalid_argument);
  BOOST_CHECK_THROW(solve_minimax(5, 0.5), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(a_bound_that_no_weights_reach_is_said, *boost::unit_test::label("sweep")) {
  BOOST_CHECK_THROW(solve_minimax(2, 0.49), std::runtime_error);
}

BOOST_AUTO_TEST_SUITE_END()
