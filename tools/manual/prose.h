#pragma once

#include <string>
#include <utility>
#include <vector>

namespace misfit::tools {

/// The text of a manual page beside the descriptions of options.
struct Prose {
  std::vector<std::string> description;                       ///< paragraphs
  std::vector<std::pair<std::string, std::string>> files;     ///< name, and what it holds
  std::vector<std::pair<std::string, std::string>> examples;  ///< what it does, and the line that is typed
};

/// The prose of a command, such as "misfit image"; empty where there is none.
Prose prose_of(const std::string& command);

/// The environment variables that every command reads, and their purposes.
const std::vector<std::pair<std::string, std::string>>& environment_prose();

/// The exit codes of the program, and when it returns them.
const std::vector<std::pair<std::string, std::string>>& exit_status_prose();

}  // namespace misfit::tools
