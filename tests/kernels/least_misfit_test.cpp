#include "kernels/least_misfit.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>
#include <utility>

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

/// The kernel that a reference tells of, solved once for all cases.
const LeastMisfit& solved_for(const testing::ReferenceKernel& reference) {
  static std::map<std::pair<int, double>, LeastMisfit> known;
  const auto [found, is_new] = known.try_emplace({reference.width, reference.x0});
  if (is_new) found->second = solve_least_misfit(reference.width, reference.x0);
  return found->second;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(least_misfit)

BOOST_DATA_TEST_CASE(solution_agrees_with_independent_values, bdata::make(testing::reference_kernels()), reference) {
  const LeastMisfit& solved = solved_for(reference);
  // The references were integrated to 1e-9 or better; the solver asks 1e-6 of itself.
  BOOST_TEST(solved.origin.mean_error == reference.mean_error, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(solved.origin.max_error == reference.max_error, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(solved.origin.condition == reference.condition, boost::test_tools::tolerance(1e-4));  // given to 5 digits
  Eigen::VectorXd x(5);
  for (int i = 0; i < 5; ++i) x[i] = i * reference.x0 / 4;
  const Eigen::VectorXd h = optimal_correction(solved.taps, x);
  for (int i = 0; i < 5; ++i) BOOST_TEST(h[i] == reference.h[static_cast<std::size_t>(i)], boost::test_tools::tolerance(1e-8));
  for (std::size_t j = 0; j < reference.taps.size(); ++j) {
    const double u = reference.width * (100 * static_cast<double>(j) + 37) / 4000;
    BOOST_TEST(std::abs(value(solved, u) - reference.taps[j]) < 1e-8);
  }
}

BOOST_DATA_TEST_CASE(the_stored_polynomial_is_as_good_as_the_solution, bdata::make(testing::reference_kernels()), reference) {
  const Kernel kernel = store("least-misfit", solved_for(reference));
  // 1e-6, and what doubles hold: an RMS of some units of rounding, 1.1e-16, which adds to that of the function.
  BOOST_TEST(std::sqrt(kernel.misfit.mean) < (1 + 1e-6) * std::sqrt(reference.mean_error) + 1e-15);
  BOOST_TEST(kernel.origin.mean_error == reference.mean_error, boost::test_tools::tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(solver_converges_over_its_whole_range_and_width_always_helps, *boost::unit_test::label("sweep")) {
  for (const double x0 : {0.01, 0.013, 0.03, 0.06, 0.1, 0.17, 0.23, 0.31, 0.37, 0.42, 0.421, 0.45, 0.47, 0.48, 0.49}) {
    double narrower = 1;
    for (const int width : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 13}) {
      const LeastMisfit solved = solve_least_misfit(width, x0);
      BOOST_TEST(solved.origin.mean_error < 0.5 * narrower);
      BOOST_TEST(solved.h_step < 1e-8);
      narrower = solved.origin.mean_error;
    }
  }
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(the_hardest_corners_converge, bdata::make({0.01, 0.49}), x0) {
  BOOST_TEST(solve_least_misfit(least_misfit_max_width, x0).h_step < 1e-8);
}

BOOST_DATA_TEST_CASE(no_change_of_h_lowers_the_error, bdata::make({2, 3, 5, 6}) * bdata::make({0.1, 0.25, 0.4, 0.48}), width,
                     x0) {
  // First-order conditions, from the definition of ℓ alone: the mean error with taps moved by ±δ in any cell is not lower.
  const LeastMisfit solved = solve_least_misfit(width, x0);
  const double least = judge(solved.taps, x0).mean;
  for (int tap = 0; tap < width; ++tap)
    for (const double shift : {-1.0, 1.0}) {
      const double size = shift * 1e-2 * std::sqrt(least);
      const TapFunction moved = [&](double t) -> Eigen::VectorXd {
        Eigen::VectorXd c = solved.taps(t);
        c[tap] += size / 2 * (1 + t);
        c[width - 1 - tap] += size / 2 * (1 - t);
        return c;
      };
      BOOST_TEST(judge(moved, x0).mean > least);
    }
}

BOOST_AUTO_TEST_CASE(the_arithmetic_follows_the_need) {
  BOOST_TEST(solve_least_misfit(7, 0.25).origin.precision == "double");
  BOOST_TEST(solve_least_misfit(12, 0.25).origin.precision == "quadruple");
  BOOST_TEST(solve_least_misfit(13, 0.02).origin.precision == "256 bits");
}

BOOST_AUTO_TEST_CASE(correction_at_the_phase_centre_is_one) {
  for (const int width : {1, 4, 7, 10}) {
    const LeastMisfit solved = solve_least_misfit(width, 0.25);
    BOOST_TEST(optimal_correction(solved.taps, Eigen::VectorXd::Zero(1))[0] == 1.0, boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_CASE(requests_outside_the_range_are_refused) {
  for (const double x0 : {0.0, 0.009, 0.4901, 0.5, std::nan("")})
    BOOST_CHECK_THROW(solve_least_misfit(5, x0), std::invalid_argument);
  for (const int width : {0, -1, 21}) BOOST_CHECK_THROW(solve_least_misfit(width, 0.25), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
