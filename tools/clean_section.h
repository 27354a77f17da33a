#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace misfit::tools {

/// What report.json's `clean` tells, as HTML; empty where that is null.
/// The course of CLEAN in curves; empty too where there are fewer than two states.
std::string clean_progress(const nlohmann::json& clean);

/// How CLEAN ended, and a table with a row for each major cycle. What a cycle found and cleaned is what it has more than the
/// one before.
std::string clean_section(const nlohmann::json& clean);

}  // namespace misfit::tools
