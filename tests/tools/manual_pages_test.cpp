#include <CLI/CLI.hpp>
#include <boost/test/unit_test.hpp>

#include "tests/tools/markup.h"
#include "tests/tools/program.h"
#include "tools/base/files.h"
#include "tools/base/option_checks.h"
#include "tools/base/run_program.h"
#include "tools/manual/completion.h"
#include "tools/manual/pages.h"
#include "tools/manual/prose.h"
#include "tools/manual/roff.h"
#include "tools/program.h"

BOOST_AUTO_TEST_SUITE(manual_pages)

namespace {

using namespace misfit::tools;
using misfit::tools::testing::contains;
using misfit::tools::testing::TemporaryFolder;

/// The command and all below it, with what their pages and lines of completion are called by.
std::map<std::string, const CLI::App*> with_commands(const CLI::App& command, const std::string& before = "") {
  const std::string name = before + command.get_name();
  std::map<std::string, const CLI::App*> all{{name, &command}};
  for (const CLI::App* each : command.get_subcommands({})) all.merge(with_commands(*each, name + " "));
  return all;
}

std::string page_file(std::string command) {
  std::replace(command.begin(), command.end(), ' ', '-');
  return command + ".1";
}

/// What groff prints of a page, or says of it; nothing where it is not installed.
std::optional<std::string> groff(const std::string& page, const std::vector<std::string>& more) {
  const TemporaryFolder folder;
  write_file(folder / "page.1", page);
  std::vector<std::string> words{"groff", "-man", "-Tutf8", "-ww", "-P-c", "-P-b", "-P-u"};
  words.insert(words.end(), more.begin(), more.end());
  words.emplace_back("page.1");
  const std::optional<int> status = misfit::tools::run_program(words, folder / "");
  if (!status) {
    BOOST_TEST_MESSAGE("groff is not installed: pages are not printed");
    return {};
  }
  BOOST_TEST(*status == 0);
  return read_file(folder / "said");
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_option_of_every_command_is_on_its_page_and_completed) {
  const auto program = make_program({});
  const auto pages = misfit::tools::manual_pages(facts_of(*program));
  const std::string completion = bash_completion(facts_of(*program));
  const auto commands = with_commands(*program);
  BOOST_TEST(pages.size() == commands.size());
  for (const auto& [name, command] : commands) {
    const std::string page = pages.at(page_file(name));
    const std::size_t begin = completion.find("    '" + name + "') words='");
    BOOST_REQUIRE_MESSAGE(begin != std::string::npos, name);
    const std::string words = completion.substr(begin, completion.find('\n', begin) - begin) + ' ';
    for (const CLI::Option* option : command->get_options())
      for (const std::string& typed : option->get_lnames()) {
        const std::string shown = roff_escaped("--" + typed);
        BOOST_TEST((contains(page, shown + "\\fR") || contains(page, shown + ", ")), name << " --" << typed);
        BOOST_TEST((contains(words, "--" + typed + ' ') || contains(words, "--" + typed + '\'')), name << " --" << typed);
      }
  }
}

BOOST_AUTO_TEST_CASE(a_page_says_all_that_an_option_declares) {
  CLI::App app("does something", "thing");
  app.option_defaults()->always_capture_default();
  int number = 7;
  std::string mode = "fast", file;
  CLI::Option* first = app.add_option("--number", number, "How many")->expected(1, 2);
  app.add_option("--mode", mode, "How")->check(CLI::IsMember({"fast", "slow"}))->needs(first);
  app.add_option("--file", file, "Which")->required()->type_name(file_type)->check(values_are({"none"}, Others::possible));
  const std::string page = misfit::tools::manual_pages(facts_of(app)).at("thing.1");
  BOOST_TEST(contains(page, "\n\\fB\\-\\-number\\fR \\fIINT [INT]\\fR\nHow many. Default: 7.\n"));
  BOOST_TEST(
      contains(page, "\n\\fB\\-\\-mode\\fR \\fITEXT\\fR\nHow. Values: fast or slow. Default: fast. Only with \\-\\-number.\n"));
  BOOST_TEST(contains(page, "\n\\fB\\-\\-file\\fR \\fIFILE\\fR\nWhich. Values: none, \\[u2026]. Required.\n"));
  BOOST_TEST(contains(page, "\n\\fBthing\\fR \\fB\\-\\-file\\fR \\fIFILE\\fR [\\fIOPTION\\fR]...\n"));
}

BOOST_AUTO_TEST_CASE(pages_are_printed_without_a_warning) {
  for (const auto& [name, page] : misfit::tools::manual_pages(facts_of(*make_program({})))) {
    const std::optional<std::string> said = groff(page, {"-z"});
    BOOST_TEST(said.value_or("") == "", name);
  }
}

BOOST_AUTO_TEST_CASE(text_is_printed_letter_by_letter) {
  RoffPage page("page", "source");
  const std::string text = ".TH 'quoted' \"twice\" \\fB --option a-b ~/x^2 `id` − … ℓ ≤ 1";
  page.paragraph(text);
  page.as_typed("'a line\n.as it is  typed");
  const std::optional<std::string> printed = groff(page.text(), {});
  if (!printed) return;
  BOOST_TEST(contains(*printed, text), *printed);
  BOOST_TEST(contains(*printed, "'a line\n"), *printed);
  BOOST_TEST(contains(*printed, ".as it is  typed\n"), *printed);
}

BOOST_AUTO_TEST_CASE(examples_use_options_that_there_are) {
  const auto program = make_program({});
  const auto commands = with_commands(*program);
  for (const auto& [name, command] : commands)
    for (const auto& [shows, typed] : prose_of(name).examples) {
      std::istringstream words(typed);
      std::string called;
      for (std::string word; words >> word;) {
        if (word == "misfit")
          called = word;
        else if (commands.contains(called + ' ' + word))
          called += ' ' + word;
        else if (word.rfind("--", 0) == 0)
          BOOST_TEST((commands.at(called)->get_option_no_throw(word) != nullptr), called << ": " << word);
      }
    }
}

BOOST_AUTO_TEST_SUITE_END()
