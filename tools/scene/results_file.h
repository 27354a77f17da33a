#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/scene/measure.h"

namespace misfit::tools {

/// What was measured so far, so that a comparison that was stopped can go on. `owner`: what the measurements belong to.
void write_results(const std::string& path, const nlohmann::json& owner, const std::vector<PointResult>& results);

/// Fills in those of `results` whose points are in the file; nothing where there is no file, it is damaged, or it belongs to
/// another owner. Returns how many runs were found.
std::size_t read_results(const std::string& path, const nlohmann::json& owner, std::vector<PointResult>& results);

}  // namespace misfit::tools
