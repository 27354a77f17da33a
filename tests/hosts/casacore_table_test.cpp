#include "tools/hosts/casacore_table.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <stdexcept>

#include "kernels/catalogue.h"
#include "kernels/piecewise_polynomial.h"

BOOST_AUTO_TEST_SUITE(casacore_table)

using namespace misfit;
using namespace misfit::hosts;
namespace bdata = boost::unit_test::data;

namespace {

kernels::PiecewisePolynomial least_misfit(int width) {
  return kernels::kernel_family("least-misfit").make(width, 0.25).polynomial;
}

/// C(s) of one tap for |t| < 1/2: cell r of the polynomial.
double value(const kernels::PiecewisePolynomial& function, double u) {
  const double from_left = u + function.width() / 2.0;
  const auto r = static_cast<Eigen::Index>(std::floor(from_left));
  if (r < 0 || r >= function.width()) return 0;
  return function(0.5 - (from_left - static_cast<double>(r)))[r];
}

}  // namespace

BOOST_DATA_TEST_CASE(an_entry_is_the_mean_of_the_function_on_its_two_sides, bdata::xrange(1, 8) * bdata::make({7, 10, 128}),
                     width, per_cell) {
  const kernels::PiecewisePolynomial function = least_misfit(width);
  const Eigen::VectorXd table = hosts::casacore_table(function, per_cell);
  BOOST_TEST(table.size() == 4 * per_cell);
  constexpr double aside = 1e-9;
  for (Eigen::Index i = 0; i < table.size(); ++i) {
    const double u = static_cast<double>(i) / per_cell;
    const double inside = value(function, u - aside), outside = value(function, u + aside);
    const bool last_of_seven = width == 7 && 2 * i == 7 * per_cell;
    // Values of at most 1 change by less than 20 over a cell.
    BOOST_TEST(std::abs(table[i] - (last_of_seven ? inside : (inside + outside) / 2)) < 20 * aside);
  }
}

BOOST_DATA_TEST_CASE(taps_are_the_function_at_the_nearest_entry_over_their_sum, bdata::xrange(1, 8), width) {
  constexpr int per_cell = 100;
  const kernels::PiecewisePolynomial function = least_misfit(width);
  const kernels::TapFunction taps = casacore_taps(hosts::casacore_table(function, per_cell), per_cell);
  for (const double t : {-0.4912, -0.301, -0.0049, 0.0051, 0.123, 0.4949}) {  // not at a jump of even or odd widths
    const double looked_up = std::round(t * per_cell) / per_cell;
    if (looked_up == 0 && width % 2 == 0) continue;
    Eigen::VectorXd expected(casacore_cells);
    for (int r = 0; r < casacore_cells; ++r) expected[r] = value(function, r - 3 - looked_up);
    expected /= expected.sum();
    BOOST_TEST((taps(t) - expected).cwiseAbs().maxCoeff() < 1e-14);  // a few roundings of values up to 1
  }
}

BOOST_DATA_TEST_CASE(taps_at_both_ends_of_a_cell_mirror_each_other_and_sum_to_one, bdata::xrange(1, 8), width) {
  const kernels::TapFunction taps = casacore_taps(hosts::casacore_table(least_misfit(width), 64), 64);
  for (const double t : {0.0, 0.25, 0.3, 0.5}) {
    BOOST_TEST(std::abs(taps(t).sum() - 1) < 1e-15);
    BOOST_TEST((taps(t) - taps(-t).reverse()).cwiseAbs().maxCoeff() < 1e-15);
  }
}

BOOST_AUTO_TEST_CASE(halfway_between_entries_the_one_away_from_zero_is_taken) {
  const kernels::TapFunction taps = casacore_taps(hosts::casacore_table(least_misfit(7), 4), 4);
  BOOST_TEST((taps(0.125) == taps(0.25)));
  BOOST_TEST((taps(-0.125) == taps(-0.25)));
  BOOST_TEST((taps(0.124) == taps(0)));
}

BOOST_AUTO_TEST_CASE(what_casacore_cannot_hold_is_refused) {
  BOOST_CHECK_THROW(hosts::casacore_table(least_misfit(8), 100), std::invalid_argument);
  BOOST_CHECK_THROW(hosts::casacore_table(least_misfit(7), 0), std::invalid_argument);
  BOOST_CHECK_THROW(hosts::casacore_table(least_misfit(7), (1 << 20) + 1), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
