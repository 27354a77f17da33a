#include "tools/manual/pages.h"

#include <algorithm>

#include "kernels/version.h"
#include "tools/base/option_checks.h"
#include "tools/manual/prose.h"
#include "tools/manual/roff.h"

namespace misfit::tools {
namespace {

/// "a, b and c", or with another word.
std::string list(const std::vector<std::string>& names, const std::string& last) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? ' ' + last + ' ' : ", ") + names[i];
  return text;
}

/// The values behind an option: "INT [INT]".
std::string values(const OptionFacts& option) {
  constexpr int few = 3;
  if (option.most == 0) return "";
  if (option.most > few) return option.type + " ...";
  std::string text = option.type;
  for (int i = 1; i < option.most; ++i) text += " [" + option.type + ']';
  return text;
}

/// The description of an option, and the facts that the parser knows.
std::string explanation(const OptionFacts& option) {
  std::string text = option.description;
  if (!text.empty() && text.back() != '.') text += '.';
  const bool told = std::all_of(option.choices.begin(), option.choices.end(),
                                [&](const std::string& choice) { return text.find(choice) != std::string::npos; });
  if (!told) {
    std::vector<std::string> values = option.choices;
    if (option.others) values.emplace_back(and_others);
    text += " Values: " + (option.others ? joined(values, ", ") : list(values, "or")) + '.';
  }
  if (option.required) text += " Required.";
  if (!option.usual.empty() && option.usual != "[]") text += " Default: " + option.usual + '.';
  if (!option.needs.empty()) text += " Only with " + list(option.needs, "and") + '.';
  if (!option.excludes.empty()) text += " Not with " + list(option.excludes, "or") + '.';
  return text;
}

std::string page_name(const CommandFacts& command) {
  return joined(command.words, "-");
}

void add_synopsis(RoffPage& page, const CommandFacts& command) {
  page.section("SYNOPSIS");
  std::string line = "\\fB" + roff_escaped(joined(command.words, " ")) + "\\fR";
  if (!command.commands.empty()) {
    page.raw(line + " \\fICOMMAND\\fR [\\fIOPTION\\fR]...");
    return;
  }
  for (const OptionFacts& option : command.options)
    if (option.required)
      line += " \\fB" + roff_escaped(option.names.back()) + "\\fR \\fI" + roff_escaped(option.type) + "\\fR" +
              (option.most > 1 ? "..." : "");
  page.raw(line + " [\\fIOPTION\\fR]...");
}

void add_commands(RoffPage& page, const CommandFacts& command) {
  if (command.commands.empty()) return;
  page.section("COMMANDS");
  for (const CommandFacts& each : command.commands)
    page.item(each.words.back(), "", each.description + ". See " + page_name(each) + "(1).");
}

void add_options(RoffPage& page, const CommandFacts& command) {
  page.section("OPTIONS");
  std::string group = "Options";
  for (const OptionFacts& option : command.options) {
    if (option.group != group) page.subsection(group = option.group);
    page.item(joined(option.names, ", "), values(option), explanation(option));
  }
}

using Items = std::vector<std::pair<std::string, std::string>>;

void add_items(RoffPage& page, const std::string& title, const Items& items) {
  if (items.empty()) return;
  page.section(title);
  for (const auto& [name, meaning] : items) page.item(name, "", meaning);
}

void add_examples(RoffPage& page, const Items& examples) {
  if (examples.empty()) return;
  page.section("EXAMPLES");
  for (const auto& [shows, line] : examples) {
    page.paragraph(shows + ':');
    page.as_typed(line);
  }
}

/// All pages but this one.
void add_see_also(RoffPage& page, const std::vector<std::string>& names, const std::string& own) {
  page.section("SEE ALSO");
  std::string line;
  for (const std::string& name : names)
    if (name != own) line += (line.empty() ? "" : ", ") + name + "(1)";
  page.raw(roff_escaped(line));
}

std::string page_of(const CommandFacts& command, const std::vector<std::string>& names) {
  const Prose prose = prose_of(joined(command.words, " "));
  RoffPage page(page_name(command), "misfit " MISFIT_VERSION);
  page.section("NAME");
  page.raw(roff_escaped(page_name(command)) + " \\- " + roff_escaped(command.description));
  add_synopsis(page, command);
  page.section("DESCRIPTION");
  if (prose.description.empty()) page.paragraph(command.description + '.');
  for (const std::string& text : prose.description) page.paragraph(text);
  add_commands(page, command);
  add_options(page, command);
  add_items(page, "EXIT STATUS", exit_status_prose());
  add_items(page, "ENVIRONMENT", environment_prose());
  add_items(page, "FILES", prose.files);
  add_examples(page, prose.examples);
  add_see_also(page, names, page_name(command));
  return page.text();
}

/// The command and all below it.
std::vector<const CommandFacts*> with_commands(const CommandFacts& command) {
  std::vector<const CommandFacts*> all{&command};
  for (const CommandFacts& each : command.commands)
    for (const CommandFacts* below : with_commands(each)) all.push_back(below);
  return all;
}

}  // namespace

std::map<std::string, std::string> manual_pages(const CommandFacts& program) {
  const std::vector<const CommandFacts*> commands = with_commands(program);
  std::vector<std::string> names;
  for (const CommandFacts* command : commands) names.push_back(page_name(*command));
  std::map<std::string, std::string> pages;
  for (const CommandFacts* command : commands) pages[page_name(*command) + ".1"] = page_of(*command, names);
  return pages;
}

}  // namespace misfit::tools
