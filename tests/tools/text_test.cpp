#include "tools/base/text.h"

#include <boost/test/unit_test.hpp>

BOOST_AUTO_TEST_SUITE(text)

using namespace misfit::tools;

BOOST_AUTO_TEST_CASE(there_is_one_part_more_than_commas_and_none_begins_or_ends_with_white_space) {
  const auto parts = [](std::string_view text) {
    std::string shown;
    for (const std::string_view part : split_at_commas(text)) shown += "[" + std::string(part) + "]";
    return shown;
  };
  BOOST_TEST(parts("a, b c ,\td\r") == "[a][b c][d]");
  BOOST_TEST(parts(",a,,") == "[][a][][]");
  BOOST_TEST(parts("") == "[]");
}

BOOST_AUTO_TEST_SUITE_END()
