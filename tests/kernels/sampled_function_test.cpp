#include "kernels/sampled_function.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "kernels/catalogue.h"
#include "kernels/least_misfit.h"

using namespace misfit::kernels;
namespace bdata = boost::unit_test::data;

namespace {

/// C(u) from the cell that holds u; on an edge, from the side of larger u.
double from_right(const PiecewisePolynomial& c, double u) {
  const double middle = (c.width() - 1) / 2.0;
  const auto r = static_cast<int>(std::floor(u + middle + 0.5));
  return r < 0 || r >= c.width() ? 0 : c(r - middle - u)[r];
}

/// A function that is different in each cell: c(−u) = c(u), and it jumps everywhere.
PiecewisePolynomial steps(int width) {
  PiecewisePolynomial c{Eigen::MatrixXd::Zero(1, width)};
  for (int r = 0; r < width; ++r) c.coefficient(0, r) = 1 + std::min(r, width - 1 - r);
  return c;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(sampled_function)

BOOST_DATA_TEST_CASE(every_row_within_a_cell_is_the_polynomial_there,
                     bdata::make({1, 2, 3, 6, 7, 12}) * bdata::make({1, 2, 5, 64, 100}), width, per_cell) {
  const PiecewisePolynomial c = store("least-misfit", solve_least_misfit(width, 0.25)).polynomial;
  const Eigen::VectorXd value = misfit::kernels::sampled_function(c, per_cell);
  BOOST_REQUIRE(value.size() == width * per_cell / 2 + 1);
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    if ((2 * i + width * per_cell) % (2 * per_cell) == 0) continue;
    // Both compute the same t to a rounding.
    BOOST_TEST(std::abs(value[i] - from_right(c, static_cast<double>(i) / per_cell)) < 1e-14);
  }
}

BOOST_AUTO_TEST_CASE(a_jump_has_the_mean_of_both_sides_and_the_edge_the_limit_from_inside) {
  const auto sampled = [](int width, int per_cell) { return misfit::kernels::sampled_function(steps(width), per_cell); };
  BOOST_TEST(sampled(4, 2) == (Eigen::VectorXd(5) << 2, 2, 1.5, 1, 1).finished());
  BOOST_TEST(sampled(3, 2) == (Eigen::VectorXd(4) << 2, 1.5, 1, 1).finished());
  BOOST_TEST(sampled(2, 1) == (Eigen::VectorXd(2) << 1, 1).finished());
  BOOST_TEST(sampled(1, 2) == (Eigen::VectorXd(2) << 1, 1).finished());
  BOOST_TEST(sampled(3, 1) == (Eigen::VectorXd(2) << 2, 1).finished());
}

BOOST_DATA_TEST_CASE(both_ends_are_halved_where_an_entry_lies_there, bdata::make({1, 4, 5, 6, 7}) * bdata::make({2, 9, 10}),
                     width, per_cell) {
  const PiecewisePolynomial function = kernel_family("least-misfit").make(width, 0.3).polynomial;
  const Eigen::VectorXd whole = misfit::kernels::sampled_function(function, per_cell),
                        halved = sampled_to_both_ends(function, per_cell);
  BOOST_TEST(halved.head(halved.size() - 1) == whole.head(halved.size() - 1));
  BOOST_TEST(halved[halved.size() - 1] == whole[halved.size() - 1] / (width * per_cell % 2 == 0 ? 2 : 1));
}

BOOST_DATA_TEST_CASE(values_are_the_entries_on_both_sides_and_zero_beyond, bdata::make({1, 2, 3, 6, 7, 12}), width) {
  for (const PiecewisePolynomial& c : {steps(width), kernel_family("least-misfit").make(width, 0.25).polynomial}) {
    const Eigen::VectorXd entry = misfit::kernels::sampled_function(c, 64);
    const Eigen::VectorXd u = Eigen::VectorXd::LinSpaced(entry.size(), 0, width / 2.0);
    BOOST_TEST(function_values(c, u) == entry);
    BOOST_TEST(function_values(c, -u) == entry);
  }
  const Eigen::VectorXd beyond = (Eigen::VectorXd(3) << std::nextafter(width / 2.0, 99), -1e300, INFINITY).finished();
  BOOST_TEST(function_values(steps(width), beyond) == Eigen::VectorXd::Zero(3));
  BOOST_TEST(std::isnan(function_values(steps(width), Eigen::VectorXd::Constant(1, NAN))[0]));
}

BOOST_DATA_TEST_CASE(values_are_those_of_the_cell_that_holds_them_up_to_its_edges, bdata::make({1, 2, 3, 6, 7}), width) {
  const PiecewisePolynomial c = steps(width);
  for (int edge = width % 2; edge <= width; edge += 2) {  // in halves
    const Eigen::VectorXd u = (Eigen::VectorXd(2) << std::nextafter(edge / 2.0, 0), std::nextafter(edge / 2.0, 99)).finished();
    const Eigen::VectorXd value = function_values(c, u);
    BOOST_TEST(value[1] == from_right(c, u[1]));
    if (edge > 0) BOOST_TEST(value[0] == value[1] + 1);
  }
}

BOOST_AUTO_TEST_CASE(a_host_takes_the_nearest_entry_and_zero_beyond_the_end) {
  const Eigen::VectorXd table = Eigen::VectorXd::LinSpaced(11, 10, 20);  // of 4 a cell, to |u| = 2.5
  const TapFunction taps = nearest_entries(table, 4, 3);
  for (const double t : {-0.5, -0.374, -0.126, 0.0, 0.1, 0.24, 0.5})
    for (int r = 0; r < 7; ++r) {
      const double entry = std::abs(4 * (r - 3) - std::round(4 * t));
      BOOST_TEST(taps(t)[r] == (entry <= 10 ? 10 + entry : 0));
    }
}

BOOST_AUTO_TEST_SUITE_END()
