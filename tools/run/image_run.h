#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "imager/data/ranks.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

/// How a run was called, for HISTORY and the report.
struct RunCall {
  std::string command_line;
  nlohmann::json option_values;        ///< {name: value}, as typed or by default
  nlohmann::json state_option_values;  ///< those that a state of CLEAN belongs to
};

/// One run of `misfit image`, from options to files; with --dry-run its plan alone, on standard output. All ranks call it; the
/// first alone speaks and writes. Returns whether all was done, and the user did not stop CLEAN. Throws what subcommands do,
/// see command.h.
bool run_image(const ImageOptions& options, const RunCall& call, const imager::Ranks& ranks);

}  // namespace misfit::tools
