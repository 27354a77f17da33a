#include "tools/program.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tools/base/option_checks.h"
#include "tools/base/text.h"
#include "tools/base/value_checks.h"
#include "tools/version_text.h"

namespace misfit::tools {

namespace {

/// Refuses several ranks for a command that they do not share: each would do everything, and write over the others' files.
void refuse_several(CLI::App& command, const imager::Ranks& ranks) {
  if (ranks.alone() || command.get_name() == "image" || command.get_name() == "predict") return;
  command.preparse_callback([&ranks, name = command.get_name()](std::size_t) {
    throw std::invalid_argument("misfit " + name + " was started as " + std::to_string(ranks.size()) +
                                " processes, which share the work of image and predict alone; expected one");
  });
}

/// The parser's words on a value that is no number, before "--option = value".
const std::string conversion_failed = "Could not convert: ";

/// Lets options take whole numbers from other programs' arithmetic, too, such as 512.0, and refuses '' as a number, which the
/// parser takes for 0.
void take_numbers(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    const std::string type = option->get_type_name();
    if (type.find("INT") != std::string::npos) option->transform(whole_number());
    if (type.find("INT") != std::string::npos || type.find("FLOAT") != std::string::npos)
      option->check([name = option->get_name()](const std::string& value) -> std::string {
        if (value.empty()) throw CLI::ConversionError(conversion_failed + name + " = ", CLI::ExitCodes::ConversionError);
        return "";
      });
  }
  for (CLI::App* sub : command.get_subcommands({})) take_numbers(*sub);
}

/// The command that was called, or the last one before a word that is no command.
const CLI::App& called(const CLI::App& program) {
  const CLI::App* command = &program;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  return *command;
}

/// A message on words that no option takes: on the options among them, which come before their values, or on all.
std::string unexpected(const std::vector<std::string>& words) {
  std::vector<std::string> options;
  for (const std::string& word : words)
    if (word.size() > 1 && word.front() == '-' && std::isalpha(static_cast<unsigned char>(word.back())) != 0)
      options.push_back(word);
  if (options.empty()) options = words;
  std::reverse(options.begin(), options.end());  // it shows the last first
  return CLI::ExtrasError(options).what();
}

/// "a, b or c".
std::string either(const std::vector<std::string>& words) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) list += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return list;
}

/// The values that an option takes, in words, for a message on `value`, which is none.
std::string wanted(const CLI::Option& option, const std::string& value) {
  if (option.get_items_expected_max() == 0) return "true or false";
  const bool several = option.get_items_expected_max() > 1;
  const std::string type = option.get_type_name(), whole = several ? "whole numbers" : "a whole number";
  if (type.find("FLOAT") != std::string::npos) return several ? "numbers" : "a number";
  if (type.find("UINT") != std::string::npos)
    return whole + " from 0 to " + std::to_string(std::numeric_limits<unsigned>::max());
  // Text of digits alone, or lists of it, can only be too large.
  const std::size_t digits = value.find_first_of("0123456789");
  const bool too_large = digits <= 1 && value.size() > 9 &&
                         value.find_first_not_of(several ? "0123456789," : "0123456789", digits) == std::string::npos;
  return whole + (too_large ? " of magnitude " + std::to_string(std::numeric_limits<int>::max()) + " at most" : "");
}

/// The first sentence of an option's help, which names its quantity and unit: " (Memory that the run may take, in GiB; …)".
std::string in_brackets(const std::string& help) {
  return help.empty() ? "" : " (" + help.substr(0, help.find(". ")) + ")";
}

/// The parser's message on a value that is no number, "Could not convert: --option = value", with what was expected.
std::string conversion_message(const std::string& said, const CLI::App& command) {
  const std::size_t equals = said.find(" = "), begin = conversion_failed.size();
  if (said.rfind(conversion_failed, 0) != 0 || equals == std::string::npos) return said;
  const std::string name = said.substr(begin, equals - begin), value = said.substr(equals + 3);
  const CLI::Option* option = command.get_option_no_throw(name);
  if (option == nullptr) return said;
  return name + ' ' + (value.empty() ? "''" : value) + ": expected " + wanted(*option, value) +
         in_brackets(option->get_description());
}

/// The parser's message on a word that is not among those an option takes, "--option: word not in {a,b}", with what was
/// expected.
std::string choice_message(const std::string& said) {
  const std::string between = " not in {";
  const std::size_t colon = said.find(": "), list = said.rfind(between);
  if (colon == std::string::npos || list == std::string::npos || list < colon + 2 || said.back() != '}') return said;
  const std::string value = said.substr(colon + 2, list - colon - 2);
  const std::string names = said.substr(list + between.size(), said.size() - 1 - list - between.size());
  std::vector<std::string> words;
  for (const std::string_view word : split_at_commas(names)) words.emplace_back(word);
  return said.substr(0, colon) + ' ' + (value.empty() ? "''" : value) + ": expected " + either(words);
}

/// The parser's message on too few or too many values, "--option: At Most 2 required but received 3", with what was expected.
std::string count_message(const std::string& said, const CLI::App& command) {
  const std::string name = said.substr(0, said.find(": ")), before = "but received ";
  const CLI::Option* option = command.get_option_no_throw(name);
  if (option == nullptr) return said;
  const int least = option->get_items_expected_min(), most = option->get_items_expected_max();
  const std::string number =
      std::to_string(least) + (most == least                                   ? ""
                               : most >= CLI::detail::expected_max_vector_size ? " or more"
                                                                               : " to " + std::to_string(most));
  const std::size_t received = said.find(before);
  return name + ": expected " + number + (most == 1 ? " value" : " values") + ", found " +
         (received == std::string::npos ? (least == 1 ? "none" : "fewer") : said.substr(received + before.size()));
}

std::string in_words(const CLI::ParseError& error, const CLI::App& program) {
  const CLI::App& command = called(program);
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) return conversion_message(error.what(), command);
  if (dynamic_cast<const CLI::ValidationError*>(&error) != nullptr) return choice_message(error.what());
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) return count_message(error.what(), command);
  const bool missing = error.get_name() == "RequiredError";
  std::vector<std::string> names;
  for (const CLI::App* each : command.get_subcommands({})) names.push_back(each->get_name());
  const std::vector<std::string> rest = command.remaining();
  const bool unknown = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  if (names.empty() && (missing || unknown) && !rest.empty()) return unexpected(rest);  // may be what is missing, misspelt
  if (const auto* const checking = dynamic_cast<const CheckingProgram*>(&program); checking != nullptr && missing)
    if (std::string wrong = checking->wrong_value(command); !wrong.empty()) return wrong;
  if (names.empty() || !missing) return error.what();
  const std::string word = rest.empty() || rest.front().front() == '-' ? "" : rest.front();
  std::string said = &command == &program ? word : command.get_name() + (word.empty() ? "" : " ") + word;
  said += said.empty() ? "expected " : ": expected ";
  if (!word.empty()) names = nearest_first(word, names);
  return said + either(names);
}

}  // namespace

std::unique_ptr<CLI::App> make_program(const CommandCall& call) {
  auto program = std::make_unique<CheckingProgram>(
      "Images radio-interferometry MeasurementSets with least-misfit gridding functions", "misfit");
  program->set_version_flag("--version", version_text, "Print the version, how it was built, and the libraries it runs with");
  program->require_subcommand(1);
  program->option_defaults()->always_capture_default();
  add_image_command(*program, call);
  add_predict_command(*program, call);
  add_mosaic_command(*program, call);
  add_simulate_command(*program);
  add_kernel_command(*program);
  add_report_command(*program);
  for (CLI::App* command : program->get_subcommands({})) refuse_several(*command, call.ranks);
  take_numbers(*program);
  return program;
}

/// The message lists the subcommands where one is missing, or unknown.
std::string usage_message(const CLI::ParseError& error, const CLI::App& program) {
  return legible(in_words(error, program));  // it may hold what was typed
}

}  // namespace misfit::tools
