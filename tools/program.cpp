#include "tools/program.h"

#include <CLI/CLI.hpp>

#include "tools/command.h"
#include "tools/version_text.h"

namespace misfit::tools {

std::unique_ptr<CLI::App> make_program(const std::string& command_line) {
  auto program =
      std::make_unique<CLI::App>("Images radio-interferometry MeasurementSets with least-misfit gridding functions", "misfit");
  program->set_version_flag("--version", version_text, "Print the version, how it was built, and the libraries it runs with");
  program->require_subcommand(1);
  program->option_defaults()->always_capture_default();
  add_image_command(*program, command_line);
  add_predict_command(*program);
  add_simulate_command(*program);
  add_kernel_command(*program);
  add_report_command(*program);
  return program;
}

}  // namespace misfit::tools
