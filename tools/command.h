#pragma once

#include <string>

#include "imager/data/ranks.h"
#include "tools/base/outcome.h"

namespace CLI {
class App;
}

namespace misfit::tools {

/// How the program was called.
struct CommandCall {
  std::string command_line;                      ///< that was typed, for HISTORY and reports
  const imager::Ranks& ranks = imager::alone();  ///< that share the run
  Outcome* outcome = nullptr;  ///< gets the outcome of `image`, `predict` and `mosaic`; null: their words go to standard output
};

/// Each adds one subcommand to the program, which runs when it is the one called. They throw std::invalid_argument for wrong
/// usage, std::runtime_error for data or files that cannot be used, and Interrupted.
void add_image_command(CLI::App& program, const CommandCall& call);
void add_kernel_command(CLI::App& program);
void add_mosaic_command(CLI::App& program, const CommandCall& call);
void add_predict_command(CLI::App& program, const CommandCall& call);
void add_simulate_command(CLI::App& program);
void add_report_command(CLI::App& program);

}  // namespace misfit::tools
