#include "tools/run/selection_options.h"

#include <CLI/CLI.hpp>

#include "tools/base/option_checks.h"

namespace misfit::tools {

namespace {

std::string help_on(const ms_io::SelectionKind& kind) {
  return std::string("Select ") + kind.expected + "; all when empty";
}

}  // namespace

void declare_selection(CLI::App& command, ms_io::Selection& selection) {
  for (const ms_io::SelectionKind& kind : ms_io::selection_kinds)
    command.add_option_function<std::string>(
        std::string("--") + kind.option,
        [&selection, kind](const std::string& expression) { selection.*kind.expression = expression; }, help_on(kind));
}

void declare_selection_of_each(CLI::App& command, ms_io::Selection& selection) {
  for (const ms_io::SelectionKind& kind : ms_io::selection_kinds)
    mark(command
             .add_option_function<std::vector<std::string>>(
                 std::string("--") + kind.option,
                 [&selection, kind](const std::vector<std::string>& expressions) {
                   selection.*kind.expression = ms_io::PerSet(expressions);
                 },
                 help_on(kind))
             ->type_name("TEXT"),
         OptionMark::one_or_each);
}

std::vector<std::string> words_of(const ms_io::Selection& selection) {
  std::vector<std::string> words;
  for (const ms_io::SelectionKind& kind : ms_io::selection_kinds)
    if (const ms_io::PerSet& expression = selection.*kind.expression; !expression.empty()) {
      words.push_back(std::string("--") + kind.option);
      words.insert(words.end(), expression.values().begin(), expression.values().end());
    }
  return words;
}

}  // namespace misfit::tools
