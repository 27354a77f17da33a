#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kernels/catalogue.h"

namespace misfit::kernels {

/// Where the kernel called `name` would lie in `folder`: libmisfit_kernel_<name>.so.
std::filesystem::path plugin_file(const std::filesystem::path& folder, const std::string& name);

/// The names of the kernels whose libraries `folder` holds, sorted; none where it cannot be read.
std::vector<std::string> plugins_in(const std::filesystem::path& folder);

/// The family that the library plugin_file(folder, name) offers through kernel_plugin.h. The library stays loaded as long as
/// the program runs. Throws std::runtime_error that names the file when it cannot be loaded, or does not keep to the interface;
/// the family's `solve`, when the function fails, is not finite, or cannot be corrected for.
KernelFamily plugin_family(const std::filesystem::path& folder, const std::string& name);

}  // namespace misfit::kernels
