#include "imager/numerics/big_array.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cstdint>
#include <memory>

BOOST_AUTO_TEST_SUITE(big_array)

using misfit::imager::BigArray;
using misfit::imager::BigMemory;

BOOST_AUTO_TEST_CASE(room_for_less_keeps_the_content) {
  BigArray<int> array;
  array.reserve(1000);
  std::fill_n(array.data(), 1000, 7);
  const int* before = array.data();
  array.reserve(10);
  BOOST_TEST(array.data() == before);
  BOOST_TEST(std::all_of(before, before + 1000, [](int x) { return x == 7; }));
}

BOOST_AUTO_TEST_CASE(what_one_gives_back_the_next_takes_and_the_system_has_the_rest) {
  BigMemory::release();
  const void* first = nullptr;
  {
    BigArray<double> array;
    array.reserve(std::size_t{1} << 20);
    first = array.data();
  }
  {
    BigArray<float> smaller, another;
    smaller.reserve(1000);
    another.reserve(1000);
    BOOST_TEST(static_cast<const void*>(smaller.data()) == first);
    BOOST_TEST(static_cast<const void*>(another.data()) != first);
    BOOST_TEST(reinterpret_cast<std::uintptr_t>(another.data()) % 64 == 0U);
  }
  BigMemory::release();
}

BOOST_AUTO_TEST_SUITE_END()
