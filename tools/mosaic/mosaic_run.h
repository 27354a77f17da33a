#pragma once

#include "tools/command.h"
#include "tools/mosaic/mosaic_options.h"

namespace misfit::tools {

/// Makes the mosaic and writes it, as the options say. Throws std::invalid_argument for wrong usage, std::runtime_error that
/// names the file or option and what was expected, and Interrupted. Nothing appears under a final name before all planes are
/// made.
void run_mosaic(const MosaicOptions& options, const CommandCall& call);

}  // namespace misfit::tools
