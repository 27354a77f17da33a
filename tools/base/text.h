#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace misfit::tools {

/// `text` without the white space around it.
std::string_view trimmed(std::string_view text);

/// The finite number that `text` is as a whole, with a sign or without; nothing where it is none.
std::optional<double> finite_number(std::string_view text);

/// `word` as a shell takes it for one: as it is, or in quotes where it holds anything but letters, digits and ./:,=+-_~%@.
std::string shell_quoted(const std::string& word);

}  // namespace misfit::tools
