#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace misfit::tools {

/// Both tell in HTML what `clean` of report.json holds, and nothing where it is null.

/// The course of CLEAN in curves; nothing either of fewer than two states.
std::string clean_progress(const nlohmann::json& clean);

/// How CLEAN ended, and a table with a row for each major cycle. What a cycle found and cleaned is what it has more than the
/// one before.
std::string clean_section(const nlohmann::json& clean);

}  // namespace misfit::tools
