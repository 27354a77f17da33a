#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace misfit::tools {

/// What report.json tells of a cube's planes, as a sentence and a table; empty where it tells of none. Of many planes the table
/// shows the first ones, and says so.
std::string cube_section(const nlohmann::json& report);

}  // namespace misfit::tools
