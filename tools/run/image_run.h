#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "imager/data/ranks.h"
#include "tools/base/outcome.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

/// How a run was called, for HISTORY and the report.
struct RunCall {
  std::string command_line;
  nlohmann::json option_values;  ///< {name: value}, as typed or by default
  StateOptionValues state_option_values;
};

/// One run of `misfit image`, from options to files; with --dry-run its plan alone, and what of report.json is known then. All
/// ranks call it; the first alone speaks and writes. Throws what subcommands do, see command.h.
Outcome run_image(const ImageOptions& options, const RunCall& call, const imager::Ranks& ranks);

}  // namespace misfit::tools
