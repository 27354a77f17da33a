#include "kernels/least_misfit.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/kernels/reference_kernels.h"

using namespace misfit::kernels;
namespace bdata = boost::unit_test::data;

namespace misfit::kernels::testing {
std::ostream& operator<<(std::ostream& out, const ReferenceKernel& k) {
  return out << "W = " << k.width << ", x0 = " << k.x0;
}
}  // namespace misfit::kernels::testing

namespace {

/// C(u) of a solution: tap r at t is C(s_r − t).
double value(const LeastMisfit& kernel, double u) {
  const double middle = (kernel.width - 1) / 2.0;
  const int r = std::clamp(static_cast<int>(std::lround(u + middle)), 0, kernel.width - 1);
  return kernel.taps(r - middle - u)[r];
}

}  // namespace

BOOST_AUTO_TEST_SUITE(least_misfit)

BOOST_DATA_TEST_CASE(mean_error_agrees_with_independent_values, bdata::make(testing::reference_kernels()), reference) {
  if (reference.mean_error <= 1e-29) return;  // below the rounding of doubles
  const LeastMisfit solved = solve_least_misfit(reference.width, reference.x0).back();
  const double tolerance = reference.mean_error < 1e-26 ? 1e-2 : 1e-4;
  BOOST_TEST(solved.mean_error == reference.mean_error, boost::test_tools::tolerance(tolerance));
  // Judging the taps by the definition of ℓ agrees with what the solver says of itself.
  BOOST_TEST(judge(solved.taps, reference.x0).mean == reference.mean_error,
             boost::test_tools::tolerance(std::max(tolerance, 2e-2)));
}

BOOST_DATA_TEST_CASE(correction_and_values_agree_with_independent_values, bdata::make(testing::reference_kernels()),
                     reference) {
  if (reference.mean_error <= 1e-22) return;  // C and h are less well determined than E; see the header of the solver
  const LeastMisfit solved = solve_least_misfit(reference.width, reference.x0).back();
  Eigen::VectorXd x(5);
  for (int i = 0; i < 5; ++i) x[i] = i * reference.x0 / 4;
  const Eigen::VectorXd h = optimal_correction(solved.taps, x);
  for (int i = 0; i < 5; ++i) BOOST_TEST(h[i] == reference.h[static_cast<std::size_t>(i)], boost::test_tools::tolerance(1e-6));
  for (std::size_t j = 0; j < reference.taps.size(); ++j) {
    const double u = reference.width * (100 * static_cast<double>(j) + 37) / 4000;
    BOOST_TEST(std::abs(value(solved, u) - reference.taps[j]) < 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(solver_converges_over_its_whole_range_and_width_always_helps) {
  for (int i = 0; i <= 44; ++i) {
    const double x0 = 0.05 + 0.01 * i;
    const auto solved = solve_least_misfit(least_misfit_max_width, std::min(x0, least_misfit_max_x0));
    for (std::size_t w = 1; w < solved.size(); ++w)
      if (solved[w - 1].mean_error > 1e-26) BOOST_TEST(solved[w].mean_error < 0.5 * solved[w - 1].mean_error);
  }
}

BOOST_DATA_TEST_CASE(stored_polynomial_costs_less_than_half_a_percent, bdata::xrange(1, 12) * bdata::make({0.25, 0.33, 0.45}),
                     width, x0) {
  const LeastMisfit solved = solve_least_misfit(width, x0).back();
  const Kernel kernel = least_misfit_up_to(width, x0).back();
  BOOST_TEST(kernel.misfit.mean < 1.0051 * solved.mean_error);
}

BOOST_AUTO_TEST_CASE(correction_at_the_phase_centre_is_one) {
  for (const int width : {1, 4, 7, 10}) {
    const LeastMisfit solved = solve_least_misfit(width, 0.25).back();
    BOOST_TEST(optimal_correction(solved.taps, Eigen::VectorXd::Zero(1))[0] == 1.0, boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_CASE(requests_outside_the_range_are_refused) {
  for (const double x0 : {0.0, 0.049, 0.4901, 0.5, std::nan("")})
    BOOST_CHECK_THROW(solve_least_misfit(5, x0), std::invalid_argument);
  for (const int width : {0, -1, 12}) BOOST_CHECK_THROW(solve_least_misfit(width, 0.25), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
