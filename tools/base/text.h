#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace misfit::tools {

/// `text` without the white space around it.
std::string_view trimmed(std::string_view text);

/// The parts of `text` between its commas, trimmed: one part more than it has commas.
std::vector<std::string_view> split_at_commas(std::string_view text);

/// The finite number that `text` is as a whole, with a sign or without; nothing where it is none.
std::optional<double> finite_number(std::string_view text);

/// The first control character of `text` but tabs, as "the control character 0x1b"; empty where there is none.
std::string control_character_of(std::string_view text);

/// `text`, which may come from anybody's file, in one line that a terminal prints and does not obey: control characters, and
/// bytes that are not UTF-8, become ?.
std::string legible(std::string_view text);

/// `names`, sorted by how few letters must be changed, added or removed to make `word`.
std::vector<std::string> nearest_first(const std::string& word, std::vector<std::string> names);

/// `word` as a shell takes it for one: as it is, or in quotes where it holds anything but letters, digits and ./:,=+-_~%@.
std::string shell_quoted(const std::string& word);

}  // namespace misfit::tools
