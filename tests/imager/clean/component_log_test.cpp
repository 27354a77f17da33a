#include "imager/clean/component_log.h"

#include <boost/test/unit_test.hpp>
#include <map>
#include <random>
#include <set>
#include <utility>

BOOST_AUTO_TEST_SUITE(component_log)

using namespace misfit::imager;

namespace {

using Flux = std::map<std::pair<int, int>, double>;

/// Factors are multiples of 1/8 below 2, so that sums of them are exact.
std::vector<PointComponent> random_components(int count, int side) {
  std::mt19937 generator(1);
  const auto below = [&](int end) { return static_cast<int>(generator() % static_cast<unsigned>(end)); };
  std::vector<PointComponent> components;
  for (int i = 0; i < count; ++i) components.push_back({below(side), below(side), static_cast<float>(below(31) - 15) / 8});
  return components;
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_came_since_any_component_sums_to_these_components_and_no_others) {
  const std::vector<PointComponent> all = random_components(200, 60);
  ComponentLog log;
  for (std::size_t size = 0; size <= all.size(); ++size) {
    if (size > 0) log.add(all[size - 1]);
    BOOST_REQUIRE(log.size() == size);
    Flux should;
    for (std::size_t first = size + 1; first-- > 0;) {
      if (first < size) should[{all[first].row, all[first].column}] += double{all[first].factor};
      Flux is;
      for (const auto& piece : log.since(first))
        for (const PointComponent& c : piece) is[{c.row, c.column}] += double{c.factor};
      BOOST_REQUIRE((is == should));
    }
  }
}

BOOST_AUTO_TEST_CASE(components_of_few_pixels_are_merged) {
  ComponentLog log;
  for (const PointComponent& c : random_components(1024, 2)) log.add(c);
  const ComponentLog::Pieces pieces = log.since(0);
  BOOST_TEST(pieces.size() == 1);
  BOOST_TEST(pieces.front().size() == 4);
}

BOOST_AUTO_TEST_CASE(pieces_are_few) {
  ComponentLog log;
  for (const PointComponent& c : random_components(1000, 60)) log.add(c);
  // Two of each length that is merged, 16 … 512, and what is left over at either end.
  for (std::size_t first = 0; first < log.size(); ++first) BOOST_TEST(log.since(first).size() <= 2 * 6 + 2);
}

BOOST_AUTO_TEST_SUITE_END()
