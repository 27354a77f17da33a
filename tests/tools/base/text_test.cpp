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

BOOST_AUTO_TEST_CASE(a_terminal_gets_letters_of_all_scripts_and_nothing_that_it_would_obey) {
  BOOST_TEST(legible("Ström, 電波, 𝒱 and \xef\xbf\xbd") == "Ström, 電波, 𝒱 and \xef\xbf\xbd");
  BOOST_TEST(legible("\x1b[2Ja\nb\tc\r\x7f") == "?[2Ja?b?c??");
  BOOST_TEST(legible(std::string_view("a\0b", 3)) == "a?b");
  BOOST_TEST(legible("\xc2\x9b"
                     "2J \xc2\xa0") == "?2J \xc2\xa0");                                      // U+009B obeys as ESC [ does
  BOOST_TEST(legible("M\xfcller \x9b") == "M?ller ?");                                       // Latin-1
  BOOST_TEST(legible("\xc0\xaf \xe0\x80\xaf \xf0\x80\x80\xaf") == "?? ??? ????");            // longer than they must be
  BOOST_TEST(legible("\xed\xa0\x80 \xf4\x90\x80\x80 \xf5\x80\x80\x80") == "??? ???? ????");  // surrogates, past the end
  BOOST_TEST(legible("\xe9\x9b") == "??");                                                   // cut
  BOOST_TEST(legible("\xe9\x9b\x1b[0m") == "???[0m");
}

BOOST_AUTO_TEST_SUITE_END()
