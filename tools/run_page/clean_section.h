#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace misfit::tools {

/// Both show `clean` of report.json in HTML, and nothing where it is null.

/// The course of CLEAN in curves; nothing for fewer than two states.
std::string clean_progress(const nlohmann::json& clean);

/// How CLEAN ended, and a table with a row for each major cycle. A cycle found and cleaned the difference of its state to the
/// one before.
std::string clean_section(const nlohmann::json& clean);

}  // namespace misfit::tools
