#pragma once

#include <filesystem>
#include <string>

#include "kernels/catalogue.h"

namespace misfit::tools {

/// Whether `kernel`, as given to --kernel, is a kernel-table file: no name of the catalogue, but something with a slash, with
/// the ending .fits, or that exists.
bool is_kernel_file(const std::string& kernel);

/// The family that `kernel` names: of the catalogue, with the user's cache, or the only kernel of a file. Throws
/// std::invalid_argument that lists the names for a kernel that is not known, std::runtime_error that names the file when it
/// cannot be read or has changed since it was written.
kernels::KernelFamily choose_kernel(const std::string& kernel);

/// Where solved kernels are kept: $MISFIT_CACHE, else misfit in $XDG_CACHE_HOME, else .cache/misfit in $HOME, else nowhere (an
/// empty path).
std::filesystem::path default_cache_folder();

}  // namespace misfit::tools
