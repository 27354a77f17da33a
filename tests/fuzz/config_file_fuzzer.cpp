// Files of options, as image --config reads them, with the checks that come before data are looked at.
#include <CLI/CLI.hpp>

#include "tests/fuzz/fuzzing.h"
#include "tools/formats/config_file.h"
#include "tools/run/image_options.h"

using namespace misfit;
using namespace misfit::fuzz;

namespace {

/// The command `image` without what it does.
struct ImageCommand {
  CLI::App program{"", "misfit"};
  CLI::App* command = program.add_subcommand("image", "");
  tools::ImageOptions options;
  bool checked = false;

  ImageCommand() {
    program.option_defaults()->always_capture_default();
    command->option_defaults()->always_capture_default();
    tools::add_config_option(*command);
    tools::declare(*command, options);
    command->callback([this] {
      tools::check(options);
      checked = true;
    });
  }
  void read(const std::string& path) { program.parse(std::vector<std::string>{path, "--config", "image"}); }  // from the last
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const InputFile file(data, size, "run.ini");
  ImageCommand first;
  read_or_refused("", [&] { return first.read(file.path()), true; });
  if (!first.checked) return 0;
  const std::string text = tools::config_text(*first.command);
  const InputFile written(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), "again.ini");
  ImageCommand again;
  again.read(written.path());
  require(tools::config_text(*again.command) == text, "options that were written are read again");
  return 0;
}
