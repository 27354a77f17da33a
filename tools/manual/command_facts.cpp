#include "tools/manual/command_facts.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "tools/base/option_checks.h"
#include "tools/base/text.h"

namespace misfit::tools {
namespace {

/// The names of the options of a set, which is ordered by address.
std::vector<std::string> sorted_names(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::sort(names.begin(), names.end());
  return names;
}

/// Takes a type of --help apart, "TEXT:{mfs,cube}".
void take_type(const std::string& type, OptionFacts& facts) {
  facts.type = type.substr(0, type.find(':'));
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return;
  const std::string list = type.substr(begin + 1, end - begin - 1);
  for (const std::string_view choice : split_at_commas(list))
    if (choice == and_others)
      facts.others = true;
    else
      facts.choices.emplace_back(choice);
}

OptionFacts facts_of(const CLI::Option& option) {
  OptionFacts facts;
  for (const std::string& name : option.get_snames()) facts.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) facts.names.push_back("--" + name);
  facts.group = option.get_group();
  facts.description = option.get_description();
  facts.most = option.get_items_expected_max();
  if (facts.most > 0) {
    take_type(option.get_type_name(), facts);
    facts.usual = option.get_default_str();
    if (facts.type == "BOOLEAN") facts.usual = facts.usual == "1" ? "true" : "false";
  }
  facts.required = option.get_required();
  facts.needs = sorted_names(option.get_needs());
  facts.excludes = sorted_names(option.get_excludes());
  return facts;
}

}  // namespace

bool OptionFacts::takes_file() const {
  return type.find("FILE") != std::string::npos || type.find("PATH") != std::string::npos;
}

bool OptionFacts::takes_folder() const {
  return type.find("FOLDER") != std::string::npos && !takes_file();
}

CommandFacts facts_of(const CLI::App& command, const std::vector<std::string>& before) {
  CommandFacts facts;
  facts.words = before;
  facts.words.push_back(command.get_name());
  facts.description = command.get_description();
  for (const std::string& group : command.get_groups())
    for (const CLI::Option* option : command.get_options())
      if (option->get_group() == group && !group.empty()) facts.options.push_back(facts_of(*option));
  for (const CLI::App* each : command.get_subcommands({})) facts.commands.push_back(facts_of(*each, facts.words));
  return facts;
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

}  // namespace misfit::tools
