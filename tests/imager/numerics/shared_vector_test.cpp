#include "imager/numerics/shared_vector.h"

#include <boost/test/unit_test.hpp>

BOOST_AUTO_TEST_SUITE(shared_vector)

using misfit::imager::SharedVector;

BOOST_AUTO_TEST_CASE(copies_share_values_until_one_is_edited) {
  SharedVector<double> one{1, 2, 3};
  SharedVector<double> other = one;
  BOOST_TEST(other.data() == one.data());
  other.edit()[1] = 7;
  BOOST_TEST(other.data() != one.data());
  BOOST_TEST(one[1] == 2);
  BOOST_TEST(other[1] == 7);
  const double* const own = other.data();
  other.edit()[2] = 8;  // nobody shares it now
  BOOST_TEST(other.data() == own);
}

BOOST_AUTO_TEST_CASE(none_are_empty_and_grow) {
  SharedVector<double> list;
  BOOST_TEST(list.empty());
  BOOST_TEST((list.begin() == list.end()));
  list.append({1, 2});
  SharedVector<double> longer = list;
  longer.append(list.begin(), list.end());
  BOOST_TEST(list.size() == 2U);
  BOOST_TEST((longer == SharedVector<double>{1, 2, 1, 2}));
}

BOOST_AUTO_TEST_CASE(equal_are_those_of_equal_values) {
  BOOST_TEST((SharedVector<double>{1, 2} == SharedVector<double>{1, 2}));
  BOOST_TEST((SharedVector<double>{1, 2} != SharedVector<double>{1, 3}));
  BOOST_TEST((SharedVector<double>{1, 2} != SharedVector<double>{1}));
  BOOST_TEST((SharedVector<double>{} == SharedVector<double>()));
}

BOOST_AUTO_TEST_SUITE_END()
