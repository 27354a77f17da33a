#include "tools/kernel_choice/kernel_choice.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>

#include "kernels/kernel_cache.h"
#include "kernels/kernel_table.h"
#include "kernels/plugin_family.h"
#include "tools/base/option_checks.h"
#include "tools/kernel_choice/cache_folder.h"

namespace misfit::tools {
namespace {

namespace fs = std::filesystem;

bool is_in_catalogue(const std::string& name) {
  const auto& families = kernels::kernel_catalogue();
  return name.rfind("spheroidal-exact-", 0) == 0 ||  // and an order
         std::any_of(families.begin(), families.end(), [&](const kernels::KernelFamily& f) { return f.name == name; });
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

bool is_path(const std::string& name) {
  return name.find('/') != std::string::npos || fs::path(name).extension() == ".fits";
}

bool is_plugin(const KernelSource& kernel) {
  return !kernel.folder.empty() && !kernel.name.empty() && !is_path(kernel.name) &&
         is_there(kernels::plugin_file(kernel.folder, kernel.name));
}

kernels::KernelFamily family_of_file(const std::string& path) {
  kernels::KernelFamily family = kernels::family_of(kernels::read_intact_kernel_table(path).kernel);
  family.name = path;
  return family;
}

/// Throws std::invalid_argument where the name of a library is that of something else too.
void check_unique(const KernelSource& kernel) {
  const std::string file = kernels::plugin_file(kernel.folder, kernel.name);
  const std::string means = "kernel \"" + kernel.name + "\" means both ";
  if (is_in_catalogue(kernel.name))
    throw std::invalid_argument(means + "the one that misfit has and " + file +
                                "; expected a library by another name, or another --kernel-folder");
  std::error_code ignored;
  if (fs::is_regular_file(kernel.name, ignored))
    throw std::invalid_argument(means + "the file of this name here and " + file + "; expected ./" + kernel.name +
                                " for the file, or that file elsewhere for the library");
}

/// The names that a library can have, after "expected one of".
std::string libraries_in(const KernelSource& kernel) {
  if (kernel.folder.empty()) return "or with --kernel-folder a library";
  std::string known;
  for (const std::string& name : kernels::plugins_in(kernel.folder)) known += (known.empty() ? "" : ", ") + name;
  const std::string none = is_there(kernel.folder) ? ", nor any other kernel's" : ": there is no such folder";
  return "or a library: " + kernels::plugin_file(kernel.folder, kernel.name).string() + " does not exist" +
         (known.empty() ? none : "; that folder has " + known);
}

}  // namespace

void list_kernels(CLI::Option& option) {
  std::vector<std::string> names;
  for (const kernels::KernelFamily& family : kernels::kernel_catalogue()) names.push_back(family.name);
  option.type_name(name_or_file_type)->check(values_are(names, Others::possible));
}

void declare_kernel_folder(CLI::App& command, std::string& folder) {
  if (const char* const given = std::getenv("MISFIT_KERNEL_FOLDER")) folder = given;
  mark(mark(command
                .add_option("--kernel-folder", folder,
                            "Folder of kernel libraries: --kernel NAME loads libmisfit_kernel_NAME.so from there; "
                            "$MISFIT_KERNEL_FOLDER when empty")
                ->type_name(folder_type),
            OptionMark::free_of_state),
       OptionMark::typed_alone);
}

bool is_kernel_file(const KernelSource& kernel) {
  if (is_in_catalogue(kernel.name)) return false;
  return is_path(kernel.name) || (is_there(kernel.name) && !is_plugin(kernel));
}

fs::path file_of(const KernelSource& kernel) {
  if (is_plugin(kernel)) return kernels::plugin_file(kernel.folder, kernel.name);
  return is_kernel_file(kernel) ? fs::path(kernel.name) : fs::path();
}

kernels::KernelFamily choose_kernel(const KernelSource& kernel) {
  if (is_plugin(kernel)) {
    check_unique(kernel);
    return kernels::plugin_family(kernel.folder, kernel.name);
  }
  if (is_kernel_file(kernel)) return family_of_file(kernel.name);
  try {
    return kernels::cached(kernels::kernel_family(kernel.name), default_cache_folder());
  } catch (const std::invalid_argument& error) {
    if (is_in_catalogue(kernel.name)) throw;
    throw std::invalid_argument(error.what() + std::string(", a kernel-table file, ") + libraries_in(kernel));
  }
}

}  // namespace misfit::tools
