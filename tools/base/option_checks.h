#pragma once

#include <map>
#include <string>
#include <vector>

namespace CLI {
class Option;
class Validator;
}  // namespace CLI

namespace misfit::tools {

/// Checks of an option's value; the parser puts the option's name before what they say.

/// That `parse`, one of quantity.h, can read it.
CLI::Validator quantity(double (*parse)(const std::string&));

/// That a number which decides nothing when it is left out is not given as 0: "0: expected …".
CLI::Validator not_zero(const std::string& expected);

/// That there is one: "" is no file's name.
CLI::Validator not_empty();

/// Puts the name that an option has for a value in place of others that people know it by, [others'] = ours; for
/// Option::transform().
CLI::Validator also_named(const std::map<std::string, std::string>& names);

/// Puts whole numbers in place of what is one, 512.0 or 1e5; for Option::transform().
CLI::Validator whole_number();

/// Whether an option takes values besides those that --help lists.
enum class Others { refused, possible };

/// Stands in such a list for the others.
inline constexpr const char* and_others = "…";

/// No check, for options whose command looks at the value itself: it says in --help, and so in manual pages and to completion,
/// what can be given.
CLI::Validator values_are(const std::vector<std::string>& names, Others others = Others::refused);

/// A mark says, where an option is declared, how code that handles all options alike treats this one.
enum class OptionMark {
  free_of_state,  ///< it only ends CLEAN or does not reach it: a run that goes on from a state may have another
  way_of_clean,   ///< it is how CLEAN goes on: so may a run with another, which then looks at its residual anew
  typed_alone,    ///< it comes from no file of options, where others could have put it
  one_or_each,    ///< it takes one value, with blanks perhaps, or several: in files of options a list has each in quotes
  not_repeated,   ///< it is no part of the run's file of options: whoever repeats a run does without it
};

/// Returns the option.
CLI::Option* mark(CLI::Option* option, OptionMark mark);
bool has(const CLI::Option& option, OptionMark mark);

/// Types of values for Option::type_name(), of options that take a path: by them --help, manual pages and completion know that.
/// A path is where something is to be, and what its name begins with.
inline constexpr const char* file_type = "FILE";
inline constexpr const char* folder_type = "FOLDER";
inline constexpr const char* path_type = "PATH";
inline constexpr const char* name_or_file_type = "NAME|FILE";

/// Throws std::invalid_argument("--option value: expected …"), for what several options decide together.
[[noreturn]] void refuse_option(const std::string& option, const std::string& value, const std::string& expected);

/// A number as it is typed, for such a message.
std::string typed(double value);

}  // namespace misfit::tools
