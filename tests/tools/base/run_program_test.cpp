#include "tools/base/run_program.h"

#include <boost/test/unit_test.hpp>

#include "tests/temporary_folder.h"
#include "tools/base/files.h"
#include "tools/base/text.h"

BOOST_AUTO_TEST_SUITE(run_program)

using namespace misfit;
using namespace misfit::tools;

BOOST_AUTO_TEST_CASE(words_reach_the_program_as_they_are_and_what_it_says_is_kept) {
  const misfit::testing::TemporaryFolder folder;
  const auto status = misfit::tools::run_program({"printf", "%s|%s|%s", "a b", "$HOME", "'\""}, folder / "");
  BOOST_TEST(status.value() == 0);
  BOOST_TEST(read_file(folder / "said") == "a b|$HOME|'\"");
}

BOOST_AUTO_TEST_CASE(a_failure_is_told_from_a_program_that_is_not_there) {
  const misfit::testing::TemporaryFolder folder;
  BOOST_TEST(misfit::tools::run_program({"false"}, folder / "").value() != 0);
  BOOST_TEST(!misfit::tools::run_program({"no-such-program-here"}, folder / "").has_value());
}

BOOST_AUTO_TEST_CASE(a_shell_takes_quoted_words_as_they_are) {
  const misfit::testing::TemporaryFolder folder;
  for (const std::string word : {"plain.ms", "my set.ms", "it's", "$HOME `id` \\ \"x\" *", ""}) {
    BOOST_TEST(misfit::tools::run_program({"sh", "-c", "printf %s " + shell_quoted(word)}, folder / "").value() == 0);
    BOOST_TEST(read_file(folder / "said") == word);
  }
  BOOST_TEST(shell_quoted("0.05arcsec") == "0.05arcsec");
}

BOOST_AUTO_TEST_SUITE_END()
