#pragma once

#include <memory>
#include <string>

#include "tools/command.h"

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace misfit::tools {

/// The program's exit codes.
enum ExitCode { done = 0, unusable_data = 1, wrong_usage = 2, stopped_by_user = 130 };

/// The program with all its commands; parsing runs the one that is called, which throws as command.h says.
std::unique_ptr<CLI::App> make_program(const CommandCall& call);

/// The parser's message on words that it does not understand, for people.
std::string usage_message(const CLI::ParseError& error, const CLI::App& program);

}  // namespace misfit::tools
