#pragma once

#include <map>
#include <string>

#include "tools/manual/command_facts.h"

namespace misfit::tools {

/// Manual pages in roff by the names of their files, "misfit-image.1": of the program and each of its commands.
std::map<std::string, std::string> manual_pages(const CommandFacts& program);

}  // namespace misfit::tools
