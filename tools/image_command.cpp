#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/base/files.h"
#include "tools/base/interrupt.h"
#include "tools/base/value_checks.h"
#include "tools/command.h"
#include "tools/formats/config_file.h"
#include "tools/run/gridding_options.h"
#include "tools/run/image_options.h"
#include "tools/run/image_run.h"
#include "tools/run/named_data.h"

namespace misfit::tools {

void add_image_command(CLI::App& program, const CommandCall& call) {
  CLI::App* command = program.add_subcommand("image", "Image and CLEAN a MeasurementSet");
  const auto options = std::make_shared<ImageOptions>();
  add_config_option(*command);
  declare(*command, *options);
  const auto check_options = [command, options] {
    CLI::Option* accuracy = command->get_option("--accuracy");
    if (accuracy->count() == 0 && kernel_is_given(options->gridding)) {
      options->gridding.accuracy = 0;
      accuracy->default_str("0");
    }
    settle_mtmfs(*command, *options);
    options->primary_beam.where_known = options->all_products();
    require_text(*command);
    check(*options);
  };
  check_before_missing(*command, check_options);
  command->callback([command, options, check_options, call] {
    check_options();
    Outcome outcome = naming(names_of(options->vis), [&] {
      return run_image(*options, {call.command_line, option_values(*command), state_option_values(*command)}, call.ranks);
    });
    const bool complete = outcome.complete;
    conclude(std::move(outcome), options->quiet || !call.ranks.first(), call.outcome);
    if (!options->dry_run && call.ranks.first()) write_file(options->imagename + ".last.ini", config_text(*command));
    if (!complete) throw Interrupted();
  });
}

}  // namespace misfit::tools
