#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace misfit::tools {

/// The planes of a cube in report.json, as a sentence and a table; empty where there are none. If there are many, the table
/// shows the first ones, and says so.
std::string cube_section(const nlohmann::json& report);

}  // namespace misfit::tools
