#pragma once

#include <string>

#include "imager/data/ranks.h"

namespace CLI {
class App;
}

namespace misfit::tools {

/// Each adds one subcommand to the program, which runs when it is the one called. `command_line` is what was typed, for HISTORY
/// and reports, `ranks` those who share the run. They throw std::invalid_argument for wrong usage, std::runtime_error for data
/// or files that cannot be used, and Interrupted.
void add_image_command(CLI::App& program, const std::string& command_line, const imager::Ranks& ranks);
void add_kernel_command(CLI::App& program);
void add_predict_command(CLI::App& program, const imager::Ranks& ranks);
void add_simulate_command(CLI::App& program);
void add_report_command(CLI::App& program);

}  // namespace misfit::tools
