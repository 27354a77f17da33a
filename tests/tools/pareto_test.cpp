#include "tools/scene/pareto.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

using namespace misfit::tools;

BOOST_AUTO_TEST_SUITE(pareto)

BOOST_AUTO_TEST_CASE(nothing_beats_the_front_and_all_else_is_beaten) {
  std::mt19937_64 random(1);
  std::vector<CostAndError> of;
  for (int i = 0; i < 300; ++i) of.push_back({double(random() % 40), double(random() % 40)});  // with equals
  const std::vector<bool> front = pareto_front(of);
  const auto beats = [](const CostAndError& a, const CostAndError& b) {
    return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
  };
  for (std::size_t i = 0; i < of.size(); ++i) {
    bool beaten = false, repeats = false;
    for (std::size_t k = 0; k < of.size(); ++k) {
      beaten = beaten || beats(of[k], of[i]);
      repeats = repeats || (k < i && of[k].cost == of[i].cost && of[k].error == of[i].error);
    }
    BOOST_TEST(front[i] == (!beaten && !repeats));
  }
}

BOOST_AUTO_TEST_CASE(of_costs_that_noise_hides_the_most_exact_is_taken) {
  std::vector<CostAndError> of{{1, 5}, {1.05, 3}, {1.15, 4}, {1.16, 2}, {1.3, 1}, {1.31, 0.5}, {3, 0.6}};
  BOOST_TEST((pareto_front(of) == std::vector<bool>{true, true, false, true, true, true, false}));
  for (CostAndError& c : of) c.noise = 0.1 / std::sqrt(8.0);  // two standard errors of a ratio are 0.1
  BOOST_TEST((pareto_front(of) == std::vector<bool>{false, true, false, true, false, true, false}));
  for (CostAndError& c : of) c.noise = 10;  // counts as a tenth: 0.28
  BOOST_TEST((pareto_front(of) == std::vector<bool>{false, false, false, true, false, true, false}));
}

BOOST_AUTO_TEST_CASE(what_was_not_measured_is_not_on_it) {
  const std::vector<bool> front = pareto_front({{NAN, 1}, {1, NAN}, {HUGE_VAL, 0.1}, {2, 1}});
  BOOST_TEST((front == std::vector<bool>{false, false, false, true}));
  BOOST_TEST(pareto_front({}).empty());
}

BOOST_AUTO_TEST_SUITE_END()
