#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace misfit::tools {

/// Where the time of a run went, in HTML: one bar of all stages and a table, the longest first. `measured` is {stage: seconds,
/// total: the wall clock}; `expected` the same as the plan foresaw, or null. Time that no stage claims is "everything else".
/// Empty where nothing was measured.
std::string time_section(const nlohmann::json& measured, const nlohmann::json& expected);

}  // namespace misfit::tools
