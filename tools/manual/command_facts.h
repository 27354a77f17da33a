#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace misfit::tools {

/// An option as its command declares it.
struct OptionFacts {
  std::vector<std::string> names;  ///< as they are typed: "-h", "--help"
  std::string group;               ///< the heading in --help
  std::string description;
  std::string type;                  ///< of its values: "INT", "NAME|FILE"; empty for a flag
  std::vector<std::string> choices;  ///< the values that it can have; empty where there is no list
  bool others = false;               ///< whether it can have other values too
  int most = 0;                      ///< the number of values that follow it at most; 0 for a flag
  std::string usual;                 ///< the value where it is not given; empty where there is none
  bool required = false;
  std::vector<std::string> needs, excludes;  ///< names of other options

  bool takes_file() const;    ///< a file, or any path
  bool takes_folder() const;  ///< a folder, and no file
};

/// A command, or the program, with all that can follow it.
struct CommandFacts {
  std::vector<std::string> words;  ///< by which it is called: "misfit", "report", "kernels"
  std::string description;
  std::vector<OptionFacts> options;
  std::vector<CommandFacts> commands;
};

/// The declarations of `command`, in the order of --help; `before` are the words of the command that it belongs to.
CommandFacts facts_of(const CLI::App& command, const std::vector<std::string>& before = {});

/// The words with `separator` between them: "misfit-report-kernels".
std::string joined(const std::vector<std::string>& words, const std::string& separator);

}  // namespace misfit::tools
