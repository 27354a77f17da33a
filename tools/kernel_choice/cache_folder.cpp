#include "tools/kernel_choice/cache_folder.h"

#include <cstdlib>

namespace misfit::tools {
namespace {

namespace fs = std::filesystem;

fs::path path_in_environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? fs::path() : fs::path(value);
}

}  // namespace

fs::path default_cache_folder() {
  if (fs::path given = path_in_environment("MISFIT_CACHE"); !given.empty()) return given;
  // The XDG Base Directory Specification has relative paths ignored.
  if (const fs::path cache = path_in_environment("XDG_CACHE_HOME"); cache.is_absolute()) return cache / "misfit";
  const fs::path home = path_in_environment("HOME");
  if (!home.is_absolute() || home == home.root_path()) return {};  // nobody's home
  return home / ".cache" / "misfit";
}

}  // namespace misfit::tools
