#include "tools/program.h"

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "tools/base/option_checks.h"
#include "tools/base/value_checks.h"
#include "tools/command.h"
#include "tools/version_text.h"

namespace misfit::tools {

namespace {

/// Commands that ranks do not share would do everything once in each, and write over each other.
void refuse_several(CLI::App& command, const imager::Ranks& ranks) {
  if (ranks.alone() || command.get_name() == "image" || command.get_name() == "predict") return;
  command.preparse_callback([&ranks, name = command.get_name()](std::size_t) {
    throw std::invalid_argument("misfit " + name + " was started as " + std::to_string(ranks.size()) +
                                " processes, which share the work of image and predict alone; expected one");
  });
}

/// Numbers of other programs' arithmetic, too.
void take_whole_numbers(CLI::App& command) {
  for (CLI::Option* option : command.get_options())
    if (option->get_type_name().find("INT") != std::string::npos) option->transform(whole_number());
  for (CLI::App* sub : command.get_subcommands({})) take_whole_numbers(*sub);
}

}  // namespace

std::unique_ptr<CLI::App> make_program(const std::string& command_line, const imager::Ranks& ranks) {
  auto program = std::make_unique<CheckingProgram>(
      "Images radio-interferometry MeasurementSets with least-misfit gridding functions", "misfit");
  program->set_version_flag("--version", version_text, "Print the version, how it was built, and the libraries it runs with");
  program->require_subcommand(1);
  program->option_defaults()->always_capture_default();
  add_image_command(*program, command_line, ranks);
  add_predict_command(*program, ranks);
  add_simulate_command(*program);
  add_kernel_command(*program);
  add_report_command(*program);
  for (CLI::App* command : program->get_subcommands({})) refuse_several(*command, ranks);
  take_whole_numbers(*program);
  return program;
}

}  // namespace misfit::tools
