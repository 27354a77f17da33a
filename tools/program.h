#pragma once

#include <memory>
#include <string>

#include "imager/data/ranks.h"

namespace CLI {
class App;
}

namespace misfit::tools {

/// What the program returns.
enum ExitCode { done = 0, unusable_data = 1, wrong_usage = 2, stopped_by_user = 130 };

/// The program with all its commands; parsing runs the one that is called, which throws as command.h says. `command_line` is
/// what was typed; `ranks`, kept by reference, those that run it together.
std::unique_ptr<CLI::App> make_program(const std::string& command_line, const imager::Ranks& ranks = imager::alone());

}  // namespace misfit::tools
