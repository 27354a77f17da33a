#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace misfit::tools {

/// The findings of --check-outside, in HTML: `outside` and `outside_search` of a run's report.json. Nothing where they are
/// null.
std::string outside_section(const nlohmann::json& report);

}  // namespace misfit::tools
