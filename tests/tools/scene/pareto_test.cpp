#include "tools/scene/pareto.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

BOOST_AUTO_TEST_SUITE(pareto)

using namespace misfit::tools;

namespace {

bool clearly_cheaper(const CostAndError& a, const CostAndError& b) {
  return a.cost * distinct_ratio(a.cost_noise, b.cost_noise) < b.cost;
}

bool clearly_more_exact(const CostAndError& a, const CostAndError& b) {
  return a.error * distinct_ratio(a.error_noise, b.error_noise) < b.error;
}

bool covers(const CostAndError& a, const CostAndError& b) {
  return !clearly_cheaper(b, a) && !clearly_more_exact(b, a);
}

/// Around a front, of costs and errors that lie as close as noise and closer.
std::vector<CostAndError> crowd(std::mt19937_64& random, double cost_noise, double error_noise) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<CostAndError> of;
  for (int i = 0; i < 60; ++i) {
    const double along = uniform(random);
    of.push_back({std::exp(along + uniform(random) / 4), std::exp(-3 * along + uniform(random)), cost_noise, error_noise});
  }
  return of;
}

}  // namespace

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

BOOST_AUTO_TEST_CASE(with_noise_the_front_covers_all_and_no_two_on_it_are_equal_or_beat_one_another) {
  std::mt19937_64 random(2);
  for (const double cost_noise : {0.0, 0.01, 0.05, 0.1})
    for (const double error_noise : {0.0, 0.02, 0.2})
      for (int repeat = 0; repeat < 20; ++repeat) {
        const std::vector<CostAndError> of = crowd(random, cost_noise, error_noise);
        const std::vector<bool> front = pareto_front(of);
        for (std::size_t i = 0; i < of.size(); ++i) {
          bool covered = false;
          for (std::size_t k = 0; k < of.size(); ++k) {
            covered = covered || (front[k] && covers(of[k], of[i]));
            if (i == k || !front[i] || !front[k]) continue;
            const bool apart = (clearly_cheaper(of[i], of[k]) && clearly_more_exact(of[k], of[i])) ||
                               (clearly_cheaper(of[k], of[i]) && clearly_more_exact(of[i], of[k]));
            BOOST_TEST(apart);
          }
          BOOST_TEST(covered);
        }
      }
}

BOOST_AUTO_TEST_CASE(where_noise_differs_the_front_still_covers_all) {
  std::mt19937_64 random(3);
  for (int repeat = 0; repeat < 100; ++repeat) {
    std::vector<CostAndError> of = crowd(random, 0, 0);
    for (CostAndError& c : of) {
      c.cost_noise = 0.02 * double(random() % 6);
      c.error_noise = 0.1 * double(random() % 6);
    }
    const std::vector<bool> front = pareto_front(of);
    for (const CostAndError& c : of) {
      bool covered = false;
      for (std::size_t k = 0; k < of.size(); ++k) covered = covered || (front[k] && covers(of[k], c));
      BOOST_TEST(covered);
    }
  }
}

BOOST_AUTO_TEST_CASE(what_beats_one_on_the_front_replaces_it) {
  // The second is as cheap but for noise as the first, and the third as the second; each is more exact.
  const std::vector<CostAndError> chain{{1, 5, 0.03}, {1.06, 3, 0.03}, {1.12, 2, 0.03}};
  BOOST_TEST((pareto_front(chain) == std::vector<bool>{true, false, true}));
  const std::vector<CostAndError> pair(chain.begin(), chain.end() - 1);
  BOOST_TEST((pareto_front(pair) == std::vector<bool>{false, true}));
}

BOOST_AUTO_TEST_CASE(a_chain_of_points_within_noise_of_the_next_keeps_its_ends) {
  std::vector<CostAndError> chain;
  for (int i = 0; i < 100; ++i) chain.push_back({std::pow(1.03, i), std::pow(0.97, i), 0.02, 0.02});  // clear from 1.057 on
  const std::vector<bool> front = pareto_front(chain);
  BOOST_TEST(front.back());
  BOOST_TEST((front[0] || front[1]));
  BOOST_TEST(std::count(front.begin(), front.end(), true) == 50);
}

BOOST_AUTO_TEST_CASE(of_costs_that_noise_hides_the_most_exact_is_taken) {
  std::vector<CostAndError> of{{1, 5}, {1.05, 3}, {1.15, 4}, {1.16, 2}, {1.3, 1}, {1.31, 0.5}, {3, 0.6}};
  BOOST_TEST((pareto_front(of) == std::vector<bool>{true, true, false, true, true, true, false}));
  for (CostAndError& c : of) c.cost_noise = 0.1 / std::sqrt(8.0);  // two standard errors of a ratio are 0.1
  BOOST_TEST((pareto_front(of) == std::vector<bool>{false, true, false, true, false, true, false}));
  for (CostAndError& c : of) c.cost_noise = 10;  // counts as a tenth: 0.28
  BOOST_TEST((pareto_front(of) == std::vector<bool>{true, false, false, false, false, true, false}));
}

BOOST_AUTO_TEST_CASE(of_errors_that_noise_hides_the_cheapest_is_taken) {
  std::vector<CostAndError> of{{1, 5}, {2, 4.5}, {3, 2}};
  BOOST_TEST((pareto_front(of) == std::vector<bool>{true, true, true}));
  for (CostAndError& c : of) c.error_noise = 0.1;
  BOOST_TEST((pareto_front(of) == std::vector<bool>{true, false, true}));
}

BOOST_AUTO_TEST_CASE(what_was_not_measured_is_not_on_it) {
  const std::vector<bool> front = pareto_front({{NAN, 1}, {1, NAN}, {HUGE_VAL, 0.1}, {2, 1}});
  BOOST_TEST((front == std::vector<bool>{false, false, false, true}));
  BOOST_TEST(pareto_front({}).empty());
}

BOOST_AUTO_TEST_SUITE_END()
