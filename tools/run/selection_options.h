#pragma once

#include <string>
#include <vector>

#include "ms_io/selection.h"

namespace CLI {
class App;
}

namespace misfit::tools {

/// Declares the options that select samples, those of ms_io::selection_kinds: of one set, or of several, for all or for each.
void declare_selection(CLI::App& command, ms_io::Selection& selection);
void declare_selection_of_each(CLI::App& command, ms_io::Selection& selection);

/// The words that give `selection` to a command: "--field", "3C295", …
std::vector<std::string> words_of(const ms_io::Selection& selection);

}  // namespace misfit::tools
