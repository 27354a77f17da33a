#pragma once

#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace misfit::tools {

/// Adds --config FILE to `command`, which must have no other option yet: options are taken from the file unless they are typed.
/// A line is `name = value`; blank lines and lines that begin with # or ; are skipped, and a value may stand in double quotes.
/// Throws std::invalid_argument that names file, line and option when an option is unknown or only to be typed
/// (OptionMark::typed_alone), and std::runtime_error when the file cannot be read.
void add_config_option(CLI::App& command);

/// The options in force, as a file for --config, without options that are empty or marked not_repeated; options marked
/// typed_alone are comments (see OptionMark).
std::string config_text(const CLI::App& command);

/// Throws std::invalid_argument that names an option whose value has a line break or another control character, which no such
/// file can hold.
void require_text(const CLI::App& command);

/// Every option of `command` that a file may hold, with the value in force: several values are separated by blanks, a flag is
/// "true" or "false".
std::vector<std::pair<std::string, std::string>> options_in_force(const CLI::App& command);

}  // namespace misfit::tools
