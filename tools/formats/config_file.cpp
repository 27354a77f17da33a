#include "tools/formats/config_file.h"

#include <CLI/CLI.hpp>
#include <iomanip>
#include <set>
#include <sstream>
#include <stdexcept>

#include "tools/base/files.h"
#include "tools/base/option_checks.h"
#include "tools/base/text.h"

namespace misfit::tools {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string unquoted(const std::string& text) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

/// Throws std::invalid_argument unless a flag can have this value.
void check_flag(const std::string& name, const std::string& value) {
  try {
    CLI::detail::to_flag_value(value);
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument("'" + name + "' is '" + value + "', expected true or false");
  }
}

std::string in_quotes(const std::string& part) {
  std::ostringstream quoted;
  quoted << std::quoted(part, '\'');
  return quoted.str();
}

/// A value as it is written in a list of an option's values.
std::string in_list(const CLI::Option& option, const std::string& part) {
  const bool one_or_each = has(option, OptionMark::one_or_each);
  const bool plain =
      one_or_each ? option.results().size() == 1 && part.substr(0, 1) != "'" : part.find_first_of(" \t'") == std::string::npos;
  return plain ? part : in_quotes(part);
}

/// Sets the option that `line` names, unless it was typed. `taken` are the names met before.
void take(CLI::App& command, const std::string& line, std::set<std::string>& taken) {
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos) throw std::invalid_argument("'" + line + "' has no =, expected name = value");
  const std::string name = trimmed(line.substr(0, equals)), value = unquoted(trimmed(line.substr(equals + 1)));
  CLI::Option* option = command.get_option_no_throw("--" + name);
  if (name.empty() || option == nullptr || !option->get_configurable())
    throw std::invalid_argument("'" + name + "' is no option of misfit " + command.get_name());
  if (has(*option, OptionMark::typed_alone))
    throw std::invalid_argument("'" + name + "' names a folder whose programs would be run; expected it on the command line");
  if (!taken.insert(name).second) throw std::invalid_argument("'" + name + "' stands in the file twice, expected it once");
  if (option->count() > 0) return;
  if (option->get_items_expected_max() == 0) check_flag(name, value);
  if (option->get_items_expected_max() == 1 || (has(*option, OptionMark::one_or_each) && value.substr(0, 1) != "'")) {
    option->add_result(value);
    return;
  }
  std::istringstream parts(value);
  for (std::string part; parts >> std::quoted(part, '\'');) option->add_result(part);
}

void take_all(CLI::App& command, const std::string& path) {
  std::istringstream lines(read_file(path));
  std::set<std::string> taken;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line = trimmed(line);
    if (line.empty() || line.front() == '#' || line.front() == ';') continue;
    try {
      if (const std::string control = control_character_of(line); !control.empty())
        throw std::invalid_argument("it has " + control + ", expected text");
      take(command, line, taken);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(path + ", line " + std::to_string(number) + ": " + error.what());
    }
  }
}

}  // namespace

void add_config_option(CLI::App& command) {
  // Callbacks run in the order in which options were added, so the callbacks of options found here are still to come.
  command
      .add_option_function<std::string>(
          "--config", [&command](const std::string& path) { take_all(command, path); },
          "Read options from a file of lines name = value; options on the command line take precedence")
      ->type_name(file_type)
      ->configurable(false);
}

std::vector<std::pair<std::string, std::string>> options_in_force(const CLI::App& command) {
  std::vector<std::pair<std::string, std::string>> values;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_lnames().empty() || !option->get_configurable()) continue;
    std::string value = option->get_default_str();
    if (option->count() > 0) {
      value.clear();
      const bool several = option->get_items_expected_max() > 1;
      for (const std::string& part : option->results())
        value += (value.empty() ? "" : " ") + (several ? in_list(*option, part) : part);
    }
    if (value.empty() && option->get_items_expected_max() == 0) value = "false";
    values.emplace_back(option->get_lnames().front(), value);
  }
  return values;
}

std::string config_text(const CLI::App& command) {
  std::string text;
  for (const auto& [name, value] : options_in_force(command)) {
    const CLI::Option& option = *command.get_option("--" + name);
    if (!value.empty() && !has(option, OptionMark::not_repeated))
      text += (has(option, OptionMark::typed_alone) ? "# on the command line: --" : "") + name + "=\"" + value + "\"\n";
  }
  return text;
}

void require_text(const CLI::App& command) {
  for (const auto& [name, value] : options_in_force(command))
    if (const std::string found = control_character_of(value); !found.empty())
      throw std::invalid_argument("--" + name + " '" + legible(value) + "': it has " + found + ", expected text");
}

}  // namespace misfit::tools
