#include "tools/kernel_choice/kernel_choice.h"

#include <algorithm>
#include <cstdlib>

#include "kernels/kernel_cache.h"
#include "kernels/kernel_table.h"

namespace misfit::tools {
namespace {

namespace fs = std::filesystem;

fs::path path_in_environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? fs::path() : fs::path(value);
}

bool is_in_catalogue(const std::string& name) {
  const auto& families = kernels::kernel_catalogue();
  return std::any_of(families.begin(), families.end(), [&](const kernels::KernelFamily& f) { return f.name == name; });
}

kernels::KernelFamily family_of_file(const std::string& path) {
  kernels::KernelFamily family = kernels::family_of(kernels::read_intact_kernel_table(path).kernel);
  family.name = path;
  return family;
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

bool is_kernel_file(const std::string& kernel) {
  if (is_in_catalogue(kernel)) return false;
  std::error_code ignored;
  return kernel.find('/') != std::string::npos || fs::path(kernel).extension() == ".fits" || fs::exists(kernel, ignored);
}

kernels::KernelFamily choose_kernel(const std::string& kernel) {
  if (is_kernel_file(kernel)) return family_of_file(kernel);
  try {
    return kernels::cached(kernels::kernel_family(kernel), default_cache_folder());
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(error.what() + std::string(", or a kernel-table file"));
  }
}

}  // namespace misfit::tools
