#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace misfit::tools::regions {

/// The statements of a line of DS9's regions, which semicolons part, but not those in braces, nor in quotes behind a #.
std::vector<std::string_view> ds9_statements(std::string_view line);

/// A statement's description of a region, and the properties behind its #.
std::pair<std::string_view, std::string_view> split_ds9_properties(std::string_view statement);

/// The properties that matter to a mask; nothing where they are not stated.
struct Ds9Properties {
  std::optional<bool> included;
  std::optional<bool> background;  ///< or source
};

/// Properties such as color=green dashlist=8 3 text={a note} background. Throws std::runtime_error that says what was expected
/// where one is none of DS9's.
Ds9Properties parse_ds9_properties(std::string_view text);

}  // namespace misfit::tools::regions
