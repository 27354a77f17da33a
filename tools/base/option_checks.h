#pragma once

#include <string>

namespace CLI {
class Validator;
}

namespace misfit::tools {

/// Checks of an option's value; the parser puts the option's name before what they say.

/// That `parse`, one of quantity.h, can read it.
CLI::Validator quantity(double (*parse)(const std::string&));

/// That there is one: "" is no file's name.
CLI::Validator not_empty();

/// Throws std::invalid_argument("--option value: expected …"), for what several options decide together.
[[noreturn]] void refuse_option(const std::string& option, const std::string& value, const std::string& expected);

/// A number as it is typed, for such a message.
std::string typed(double value);

}  // namespace misfit::tools
