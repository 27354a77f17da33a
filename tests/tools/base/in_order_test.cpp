#include "tools/base/in_order.h"

#include <boost/test/unit_test.hpp>
#include <vector>

#include "imager/numerics/parallel.h"

BOOST_AUTO_TEST_SUITE(in_order)

namespace {

using namespace misfit;

}  // namespace

BOOST_AUTO_TEST_CASE(what_threads_put_in_any_order_is_handed_on_in_order_one_at_a_time) {
  constexpr int count = 1000;
  std::vector<int> numbers, things;
  tools::InOrder<int> in_order([&](int number, int&& thing) {
    numbers.push_back(number);
    things.push_back(thing);
  });
  imager::parallel_for(count, 4, [&](std::size_t i) {
    const int number = static_cast<int>(i) ^ 7;  // of eight the last first
    in_order.put(number, 10 * number);
  });
  BOOST_TEST_REQUIRE(numbers.size() == static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    BOOST_TEST(numbers[static_cast<std::size_t>(i)] == i);
    BOOST_TEST(things[static_cast<std::size_t>(i)] == 10 * i);
  }
}

BOOST_AUTO_TEST_CASE(nothing_overtakes_what_is_missing_until_it_is_said_not_to_come) {
  std::vector<int> handed_on;
  tools::InOrder<char> in_order([&](int number, char&&) { handed_on.push_back(number); });
  for (const int number : {4, 0, 2}) in_order.put(number, 'x');
  BOOST_TEST(handed_on == std::vector<int>({0}), boost::test_tools::per_element());
  in_order.flush();
  BOOST_TEST(handed_on == std::vector<int>({0, 2, 4}), boost::test_tools::per_element());
}

BOOST_AUTO_TEST_SUITE_END()
