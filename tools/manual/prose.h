#pragma once

#include <string>
#include <utility>
#include <vector>

namespace misfit::tools {

/// What a manual page says beside what the options say of themselves.
struct Prose {
  std::vector<std::string> description;                       ///< paragraphs
  std::vector<std::pair<std::string, std::string>> files;     ///< name, and what it holds
  std::vector<std::pair<std::string, std::string>> examples;  ///< what it does, and the line that is typed
};

/// Of the command called "misfit image"; empty for one of which nothing more is to be said.
Prose prose_of(const std::string& command);

/// What is read from the environment, and what for; the same for all commands.
const std::vector<std::pair<std::string, std::string>>& environment_prose();

/// What the program returns, and when.
const std::vector<std::pair<std::string, std::string>>& exit_status_prose();

}  // namespace misfit::tools
