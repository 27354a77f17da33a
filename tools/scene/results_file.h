#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/scene/measure.h"

namespace misfit::tools {

/// Writes the measurements so far, so that a comparison that was stopped can go on. `owner`: what the measurements belong to,
/// by name.
void write_results(const std::string& path, const nlohmann::json& owner, const std::vector<PointResult>& results);

/// The content of a file of results.
struct FoundResults {
  std::size_t runs = 0;
  std::string not_used;  ///< why the file was not: "it is damaged"; empty where it was, and where there is none
};

/// Fills in those of `results` whose points are in the file; nothing where there is no file, it is damaged, or it belongs to
/// another owner.
FoundResults read_results(const std::string& path, const nlohmann::json& owner, std::vector<PointResult>& results);

}  // namespace misfit::tools
