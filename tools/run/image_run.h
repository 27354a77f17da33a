#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/run/image_options.h"

namespace misfit::tools {

/// One run of `misfit image`, from options to files; with --dry-run its plan alone, on standard output. `option_values` go into
/// the report. Returns whether all was done, and the user did not stop CLEAN. Throws what subcommands do, see command.h.
bool run_image(const ImageOptions& options, const std::string& command_line, const nlohmann::json& option_values);

}  // namespace misfit::tools
