#include <CLI/CLI.hpp>
#include <memory>

#include "tools/base/value_checks.h"
#include "tools/command.h"
#include "tools/mosaic/mosaic_options.h"
#include "tools/mosaic/mosaic_run.h"

namespace misfit::tools {

void add_mosaic_command(CLI::App& program, const CommandCall& call) {
  CLI::App* command =
      program.add_subcommand("mosaic", "Combine images of several pointings into one, weighted by their primary beams");
  const auto o = std::make_shared<MosaicOptions>();
  declare(*command, *o);
  check_before_missing(*command, [o] { check(*o); });
  command->callback([o, call] { run_mosaic(*o, call); });
}

}  // namespace misfit::tools
