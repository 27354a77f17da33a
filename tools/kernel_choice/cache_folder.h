#pragma once

#include <filesystem>

namespace misfit::tools {

/// Where solved kernels are kept: $MISFIT_CACHE, else misfit in $XDG_CACHE_HOME, else .cache/misfit in $HOME, else nowhere (an
/// empty path).
std::filesystem::path default_cache_folder();

}  // namespace misfit::tools
