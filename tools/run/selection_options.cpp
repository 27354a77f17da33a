#include "tools/run/selection_options.h"

#include <CLI/CLI.hpp>

namespace misfit::tools {

void declare_selection(CLI::App& command, ms_io::Selection& selection) {
  for (const ms_io::SelectionKind& kind : ms_io::selection_kinds)
    command.add_option(std::string("--") + kind.option, selection.*kind.expression,
                       std::string("Select ") + kind.expected + "; all when empty");
}

std::vector<std::string> words_of(const ms_io::Selection& selection) {
  std::vector<std::string> words;
  for (const ms_io::SelectionKind& kind : ms_io::selection_kinds)
    if (const std::string& expression = selection.*kind.expression; !expression.empty())
      words.insert(words.end(), {std::string("--") + kind.option, expression});
  return words;
}

}  // namespace misfit::tools
