#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace misfit::tools {

/// Checks of an option's value; the parser puts the option's name before what they say.

/// That `parse`, one of quantity.h, can read it.
CLI::Validator quantity(double (*parse)(const std::string&));

/// That there is one: "" is no file's name.
CLI::Validator not_empty();

}  // namespace misfit::tools
