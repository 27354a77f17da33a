#include "kernels/quadrature.h"

#include <array>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <thread>
#include <vector>

using misfit::kernels::gauss_legendre;

BOOST_AUTO_TEST_SUITE(quadrature)

BOOST_DATA_TEST_CASE(integrates_polynomials_of_degree_2n_minus_1_exactly, boost::unit_test::data::xrange(1, 65), points) {
  const auto rule = gauss_legendre(points, -0.5, 1.5);
  for (int degree = 0; degree < 2 * points; ++degree) {
    const double integral = rule.weight.dot(rule.node.array().pow(degree).matrix());
    const double exact = (std::pow(1.5, degree + 1) - std::pow(-0.5, degree + 1)) / (degree + 1);
    BOOST_TEST(std::abs(integral / exact - 1) < 1e-13);  // a few dozen roundings
  }
}

/// Each is the first to ask for some of the rules.
BOOST_AUTO_TEST_CASE(threads_that_ask_at_once_get_the_same_rules) {
  std::array<std::vector<misfit::kernels::Quadrature>, 4> got;
  std::vector<std::thread> threads;
  for (auto& rules : got)
    threads.emplace_back([&rules] {
      for (int points = 70; points < 110; ++points) rules.push_back(gauss_legendre(points, 0, 1));
    });
  for (std::thread& thread : threads) thread.join();
  for (const auto& rules : got)
    for (std::size_t i = 0; i < rules.size(); ++i)
      BOOST_TEST((rules[i].node == got[0][i].node && rules[i].weight == got[0][i].weight));
}

BOOST_AUTO_TEST_CASE(nodes_ascend_inside_the_interval) {
  const auto rule = gauss_legendre(31, 2, 3);
  BOOST_TEST(rule.node[0] > 2);
  BOOST_TEST(rule.node[30] < 3);
  for (int i = 1; i < 31; ++i) BOOST_TEST(rule.node[i] > rule.node[i - 1]);
}

BOOST_DATA_TEST_CASE(lobatto_integrates_polynomials_of_degree_2n_minus_3_and_holds_both_ends,
                     boost::unit_test::data::xrange(2, 50), points) {
  const auto rule = misfit::kernels::gauss_lobatto_in<double>(points, -0.5, 1.5);
  BOOST_TEST(rule.node[0] == -0.5);
  BOOST_TEST(rule.node[points - 1] == 1.5);
  for (int degree = 0; degree < 2 * points - 2; ++degree) {
    const double integral = rule.weight.dot(rule.node.array().pow(degree).matrix());
    const double exact = (std::pow(1.5, degree + 1) - std::pow(-0.5, degree + 1)) / (degree + 1);
    BOOST_TEST(std::abs(integral / exact - 1) < 1e-12);  // a few hundred roundings
  }
}

BOOST_AUTO_TEST_SUITE_END()
