#pragma once

#include <map>
#include <string>
#include <vector>

namespace CLI {
class Option;
class Validator;
}  // namespace CLI

namespace misfit::tools {

/// Checks of an option's value; the parser puts the option's name before their messages.

/// Checks that `parse`, one of quantity.h, can read the value.
CLI::Validator quantity(double (*parse)(const std::string&));

/// Checks that 0, the default that stands for "not given", is not given: "0: expected …".
CLI::Validator not_zero(const std::string& expected);

/// Checks that the value is not "", which is no file's name.
CLI::Validator not_empty();

/// Replaces names that a value has elsewhere by our name for it, [theirs] = ours; for Option::transform().
CLI::Validator also_named(const std::map<std::string, std::string>& names);

/// Writes whole numbers such as 512.0 or 1e5 as 512 or 100000; for Option::transform().
CLI::Validator whole_number();

/// An option refuses or takes values besides those that --help lists.
enum class Others { refused, possible };

/// Stands for the other values in the list of --help.
inline constexpr const char* and_others = "…";

/// No check, for options whose command looks at the value itself: it says in --help, and so in manual pages and to completion,
/// what can be given.
CLI::Validator values_are(const std::vector<std::string>& names, Others others = Others::refused);

/// A mark says, where an option is declared, how code that handles all options alike treats this one.
enum class OptionMark {
  free_of_state,  ///< it only ends CLEAN or does not reach it: a run that goes on from a state may have another value
  way_of_clean,   ///< it says how CLEAN goes on: a run from a state may have another value, and then computes its residual anew
  typed_alone,    ///< it must be typed: files of options, where others could have put it, may not hold it
  one_or_each,    ///< it takes one value, perhaps with blanks, or several: files of options have each value of a list in quotes
  not_repeated,   ///< the run's file of options leaves it out: a repeated run does without it
};

/// Returns the option.
CLI::Option* mark(CLI::Option* option, OptionMark mark);
bool has(const CLI::Option& option, OptionMark mark);

/// Types of values, for Option::type_name(), by which --help, manual pages and completion know options that take a path. A PATH
/// is the place of something to be written, and its name or the beginning of its name.
inline constexpr const char* file_type = "FILE";
inline constexpr const char* folder_type = "FOLDER";
inline constexpr const char* path_type = "PATH";
inline constexpr const char* name_or_file_type = "NAME|FILE";

/// Throws std::invalid_argument("--option value: expected …"), for what several options decide together.
[[noreturn]] void refuse_option(const std::string& option, const std::string& value, const std::string& expected);

/// A number as it is typed, for such a message.
std::string typed(double value);

}  // namespace misfit::tools
