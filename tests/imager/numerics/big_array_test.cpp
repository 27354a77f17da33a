#include "imager/numerics/big_array.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cstdint>

BOOST_AUTO_TEST_SUITE(big_array)

using misfit::imager::BigArray;

BOOST_AUTO_TEST_CASE(room_for_less_keeps_the_content) {
  BigArray<int> array;
  array.reserve(1000);
  std::fill_n(array.data(), 1000, 7);
  const int* before = array.data();
  array.reserve(10);
  BOOST_TEST(array.data() == before);
  BOOST_TEST(std::all_of(before, before + 1000, [](int x) { return x == 7; }));
}

BOOST_AUTO_TEST_CASE(it_begins_with_a_line_of_the_caches_whether_small_or_large) {
  for (const std::size_t count : {1, 1000, 5'000'000}) {
    BigArray<float> array;
    array.reserve(count);
    BOOST_TEST(reinterpret_cast<std::uintptr_t>(array.data()) % 64 == 0U);
    std::fill_n(array.data(), count, 1.0F);
  }
}

BOOST_AUTO_TEST_SUITE_END()
