#include "tools/manual/completion.h"

#include <CLI/CLI.hpp>
#include <boost/test/unit_test.hpp>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "kernels/catalogue.h"
#include "tests/temporary_folder.h"
#include "tools/base/files.h"
#include "tools/base/run_program.h"
#include "tools/base/text.h"
#include "tools/program.h"

BOOST_AUTO_TEST_SUITE(completion)

namespace {

using namespace misfit;
using namespace misfit::tools;
using Words = std::set<std::string>;

/// What bash offers after `line`, whose last word is the one that is typed; "" where a new one begins. Files and folders are
/// those of `folder`.
Words offered(const std::vector<std::string>& line, const std::string& folder) {
  const misfit::testing::TemporaryFolder work;
  write_file(work / "completion", bash_completion(facts_of(*make_program({}))));
  std::string words;
  for (const std::string& word : line) words += ' ' + shell_quoted(word);
  const std::string script = ". ./completion; cd " + shell_quoted(folder) + "; COMP_WORDS=(misfit" + words +
                             "); COMP_CWORD=" + std::to_string(line.size()) + "; _misfit; printf '%s\\n' \"${COMPREPLY[@]}\"";
  const auto status = misfit::tools::run_program({"bash", "-c", script}, work / "");
  BOOST_REQUIRE(status.has_value());
  std::istringstream said(read_file(work / "said"));
  Words all;
  for (std::string word; std::getline(said, word);)
    if (!word.empty()) all.insert(word);
  return all;
}

Words offered(const std::vector<std::string>& line) {
  const misfit::testing::TemporaryFolder folder;
  return offered(line, folder / "");
}

void check_offered(const std::vector<std::string>& line, const Words& expected) {
  const Words words = offered(line);
  BOOST_CHECK_EQUAL_COLLECTIONS(words.begin(), words.end(), expected.begin(), expected.end());
}

/// The options of a command and of all below it.
std::vector<OptionFacts> options_below(const CommandFacts& command) {
  std::vector<OptionFacts> all = command.options;
  for (const CommandFacts& each : command.commands)
    for (const OptionFacts& option : options_below(each)) all.push_back(option);
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(commands_and_options_are_completed_where_they_can_stand) {
  check_offered({""}, {"image", "predict", "mosaic", "simulate", "kernel", "report", "-h", "--help", "--version"});
  check_offered({"re"}, {"report"});
  check_offered({"report", "s"}, {"scene", "stability"});
  check_offered({"image", "--niter", "100", "--nite"}, {"--niter"});
  check_offered({"image", "--vis", "a.ms", "b.ms", "--restart", "--min"},
                {"--minbeamfrac", "--minpercentchange", "--minpsffraction", "--minuv-l"});
  check_offered({"report", "stability", "--quick", "--v"}, {"--vis"});
  BOOST_TEST(offered({"image", "--niter", "-1", ""}).contains("--vis"));
  BOOST_TEST(offered({"image", "--quiet", ""}).contains("--vis"));
}

BOOST_AUTO_TEST_CASE(values_are_completed_where_there_is_a_list_of_them) {
  check_offered({"image", "--gridder", ""}, {"auto", "mosaic", "standard", "wide"});
  check_offered({"image", "--gridder", "=", "st"}, {"standard"});  // as bash divides --gridder=st
  check_offered({"image", "--gridder", "="}, {"auto", "mosaic", "standard", "wide"});
  check_offered({"simulate", "--array", "vla-"}, {"vla-a", "vla-b", "vla-c", "vla-d"});
  check_offered({"kernel", "--emit", "c"}, {"casacore", "c-header", "csv"});
  check_offered({"image", "--niter", ""}, {});
  check_offered({"predict", "--gridder", ""}, offered({"predict", ""}));  // which is no option there
}

BOOST_AUTO_TEST_CASE(kernels_of_the_catalogue_are_completed) {
  Words names;
  for (const kernels::KernelFamily& family : kernels::kernel_catalogue()) names.insert(family.name);
  for (const char* command : {"image", "predict", "kernel"}) check_offered({command, "--kernel", ""}, names);
  check_offered({"report", "scene", "--kernel", "minimax", "pro"}, {"prolate"});
}

BOOST_AUTO_TEST_CASE(paths_are_completed_where_an_option_takes_one) {
  const misfit::testing::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "one set.ms");
  std::ofstream(folder / "one.fits") << "";
  const auto check = [&](const std::vector<std::string>& line, const Words& expected) {
    const Words words = offered(line, folder / "");
    BOOST_CHECK_EQUAL_COLLECTIONS(words.begin(), words.end(), expected.begin(), expected.end());
  };
  check({"image", "--vis", "on"}, {"one set.ms"});
  check({"image", "--vis", "x.ms", "on"}, {"one set.ms"});
  check({"image", "--mask", "on"}, {"one set.ms", "one.fits"});
  check({"kernel", "--kernel", "one."}, {"one.fits"});
  check({"image", "--cell", "on"}, {});
}

BOOST_AUTO_TEST_CASE(options_that_speak_of_files_take_paths) {
  const std::regex speaks("(^|[^a-z])(file|folder|measurementset)s?($|[^a-z])", std::regex::icase);
  for (const OptionFacts& option : options_below(facts_of(*make_program({})))) {
    const bool other = option.most == 0 || (!option.choices.empty() && !option.others);
    if (other || !std::regex_search(option.description, speaks)) continue;
    BOOST_TEST((option.takes_file() || option.takes_folder()), option.names.back() << ": " << option.description);
  }
}

BOOST_AUTO_TEST_SUITE_END()
