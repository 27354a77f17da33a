#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>

#include "tools/base/files.h"
#include "tools/manual/completion.h"
#include "tools/manual/pages.h"
#include "tools/program.h"

// misfit_manual FOLDER: writes the manual pages into FOLDER/man1, and FOLDER/misfit, the completion for bash.
int main(int argc, char** argv) {
  using namespace misfit::tools;
  if (argc != 2) {
    std::fprintf(stderr, "misfit_manual: expected a folder, where manual pages and completion go\n");
    return wrong_usage;
  }
  unsetenv("MISFIT_KERNEL_FOLDER");  // who builds has other defaults
  try {
    const CommandFacts program = facts_of(*make_program({}));
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder / "man1");
    for (const auto& [name, text] : manual_pages(program)) write_file((folder / "man1" / name).string(), text);
    write_file((folder / "misfit").string(), bash_completion(program));
    return done;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "misfit_manual: %s\n", error.what());
    return unusable_data;
  }
}
