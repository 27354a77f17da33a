#include "tools/formats/config_file.h"

#include <CLI/CLI.hpp>
#include <boost/test/unit_test.hpp>
#include <functional>

#include "tests/tools/program.h"

BOOST_AUTO_TEST_SUITE(config_file)

namespace {

using namespace misfit::tools;
using namespace misfit::tools::testing;

/// A command with an option of each sort.
struct Command {
  CLI::App app{"test", "misfit"};
  CLI::App* command = app.add_subcommand("image", "");
  std::string name = "default";
  double number = 1.5;
  std::vector<int> sizes;
  bool flag = false;

  Command() {
    app.option_defaults()->always_capture_default();
    command->option_defaults()->always_capture_default();
    add_config_option(*command);
    command->add_option("--name", name);
    command->add_option("--number", number)->required();
    command->add_option("--sizes", sizes)->expected(1, 2);
    command->add_flag("--flag", flag);
  }
  void parse(Arguments arguments) {
    arguments.insert(arguments.begin(), "image");
    std::reverse(arguments.begin(), arguments.end());
    app.parse(arguments);
  }
};

struct ConfigFile {
  TemporaryFolder folder;
  std::string path = folder / "run.ini";
  explicit ConfigFile(const std::string& text) { std::ofstream(path) << text; }
};

void check_error(const std::string& text, const std::string& expected) {
  const ConfigFile file(text);
  BOOST_CHECK_EXCEPTION(Command().parse({"--config", file.path}), std::invalid_argument, [&](const std::exception& error) {
    BOOST_TEST(error.what() == file.path + expected);
    return true;
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(options_come_from_the_file_unless_they_are_typed) {
  const ConfigFile file("# comment\n; another\n\nname = \"a = 'b' \" \r\nnumber=2.5\n  sizes = 7 8\nflag=true\n");
  Command typed;
  typed.parse({"--sizes", "5", "--config", file.path});
  BOOST_TEST(typed.name == "a = 'b' ");
  BOOST_TEST(typed.number == 2.5);
  BOOST_TEST(typed.sizes == std::vector<int>{5}, boost::test_tools::per_element());
  BOOST_TEST(typed.flag);
}

BOOST_AUTO_TEST_CASE(the_text_written_gives_the_options_back) {
  for (const Arguments& typed :
       {Arguments{"--number", "1e-3", "--sizes", "3", "--name", "it's \"odd\" = #;"},
        Arguments{"--number", "2", "--sizes", "1", "2", "--flag"}, Arguments{"--number", "-1", "--sizes", "4"}}) {
    Command first, again;
    first.parse(typed);
    const ConfigFile file(config_text(*first.command));
    again.parse({"--config", file.path});
    BOOST_TEST(again.name == first.name);
    BOOST_TEST(again.number == first.number);
    BOOST_TEST(again.sizes == first.sizes, boost::test_tools::per_element());
    BOOST_TEST(again.flag == first.flag);
    BOOST_TEST(config_text(*again.command) == config_text(*first.command));
  }
}

BOOST_AUTO_TEST_CASE(errors_name_the_file_the_line_and_the_option) {
  check_error("number=1\nflag = maybe\n", ", line 2: 'flag' is 'maybe', expected true or false");
  check_error("number=1\nnmae=a\n", ", line 2: 'nmae' is no option of misfit image");
  check_error("[image]\n", ", line 1: '[image]' has no =, expected name = value");
  check_error("config=other.ini\n", ", line 1: 'config' is no option of misfit image");
  check_error("number=1\nname=a\nname=b\n", ", line 3: 'name' stands in the file twice, expected it once");
  check_error("help=true\n", ", line 1: 'help' is no option of misfit image");
  check_error("number=1\nname=\x1b[31m\n", ", line 2: it has the control character 0x1b, expected text");
}

BOOST_AUTO_TEST_CASE(what_no_file_can_hold_is_refused_when_it_is_typed) {
  for (const std::string name : {"two\nlines", "\x1b[31m", "end\r"}) {
    Command typed;
    typed.parse({"--number", "1", "--name", name});
    BOOST_CHECK_EXCEPTION(require_text(*typed.command), std::invalid_argument, [](const std::invalid_argument& error) {
      return std::string(error.what()).find("--name '") == 0 && std::string(error.what()).find("control character") > 0;
    });
  }
  Command typed;
  typed.parse({"--number", "1", "--name", "a\tb ü"});
  BOOST_CHECK_NO_THROW(require_text(*typed.command));
}

BOOST_AUTO_TEST_CASE(wrong_values_are_refused_as_when_they_are_typed) {
  const ConfigFile file("number=many\n");
  BOOST_CHECK_THROW(Command().parse({"--config", file.path}), CLI::ConversionError);
  BOOST_CHECK_THROW(Command().parse({"--config", "/no/such.ini", "--number", "1"}), std::runtime_error);
  BOOST_CHECK_THROW(Command().parse({"--config", "/", "--number", "1"}), std::runtime_error);
}

BOOST_AUTO_TEST_SUITE_END()
