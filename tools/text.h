#pragma once

#include <optional>
#include <string_view>

namespace misfit::tools {

/// `text` without the white space around it.
std::string_view trimmed(std::string_view text);

/// The finite number that `text` is as a whole, with a sign or without; nothing where it is none.
std::optional<double> finite_number(std::string_view text);

}  // namespace misfit::tools
