#pragma once

#include <string>

#include "tools/manual/command_facts.h"

namespace misfit::tools {

/// A script that makes bash complete the program's command lines: commands, their options, and values of options that have a
/// list of them or take a path.
std::string bash_completion(const CommandFacts& program);

}  // namespace misfit::tools
