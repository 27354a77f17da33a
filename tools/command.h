#pragma once

#include <string>

namespace CLI {
class App;
}

namespace misfit::tools {

/// Each adds one subcommand to the program, which runs when it is the one called. `command_line` is what was typed, for HISTORY
/// and reports. They throw std::invalid_argument for wrong usage, std::runtime_error for data or files that cannot be used, and
/// Interrupted.
void add_image_command(CLI::App& program, const std::string& command_line);
void add_kernel_command(CLI::App& program);
void add_predict_command(CLI::App& program);
void add_simulate_command(CLI::App& program);
void add_report_command(CLI::App& program);

}  // namespace misfit::tools
