#include "kernels/conditioning.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "kernels/least_misfit.h"

using namespace misfit::kernels;
namespace bdata = boost::unit_test::data;

namespace {

using Method = TapFunction (*)(int width, double x0, const Correction& h);

/// E of the taps that `method` finds for the optimal h, over the optimum.
double loss(Method method, int width, double x0) {
  const LeastMisfit best = solve_least_misfit(width, x0);
  const Correction h = [&](const Eigen::VectorXd& x) { return optimal_correction(best.taps, x); };
  return judge(method(width, x0, h), x0).mean / best.origin.mean_error;
}

struct Onset {
  double x0;
  int width;  ///< the first at which the normal equations lose E in doubles
};
std::ostream& operator<<(std::ostream& out, const Onset& onset) {
  return out << "x0 = " << onset.x0 << ", W = " << onset.width;
}

// The project's independent findings.
const std::vector<Onset> onsets{{0.01, 5}, {0.1, 8}, {0.2, 11}, {0.25, 12}};

}  // namespace

BOOST_AUTO_TEST_SUITE(conditioning)

BOOST_DATA_TEST_CASE(both_methods_find_the_taps_of_narrow_kernels, bdata::make({1, 2, 3, 4}) * bdata::make({0.1, 0.25, 0.45}),
                     width, x0) {
  const LeastMisfit best = solve_least_misfit(width, x0);
  const Correction h = [&](const Eigen::VectorXd& x) { return optimal_correction(best.taps, x); };
  for (const Method method : {solve_by_normal_equations, solve_by_orthogonal_factors})
    for (const double t : {-0.4, 0.1, 0.5})
      BOOST_TEST((method(width, x0, h)(t) - best.taps(t)).norm() < 1e-15 * best.origin.condition + 1e-8);  // h_step is 1e-10
}

BOOST_DATA_TEST_CASE(normal_equations_lose_where_the_square_of_rounding_times_the_condition_reaches_the_error,
                     bdata::make(onsets), onset) {
  BOOST_TEST(loss(solve_by_normal_equations, onset.width, onset.x0) > 1.5);
  BOOST_TEST(loss(solve_by_normal_equations, onset.width - 1, onset.x0) < 1.15);
}

BOOST_DATA_TEST_CASE(orthogonal_factors_do_not_lose_there, bdata::make(onsets), onset) {
  BOOST_TEST(loss(solve_by_orthogonal_factors, onset.width, onset.x0) < 1.001);
}

BOOST_AUTO_TEST_CASE(orthogonal_factors_are_limited_by_the_rounding_of_values_alone) {
  BOOST_TEST(loss(solve_by_orthogonal_factors, 14, 0.25) < 1.1);  // E = 1.7e-29
  BOOST_TEST(loss(solve_by_orthogonal_factors, 15, 0.25) > 1.5);  // E = 1.5e-31
}

BOOST_AUTO_TEST_CASE(values_stored_in_single_are_floats) {
  const TapFunction taps = stored_in_single([](double t) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(2, t); });
  BOOST_TEST(taps(0.1)[0] == static_cast<double>(0.1F));
}

BOOST_AUTO_TEST_SUITE_END()
