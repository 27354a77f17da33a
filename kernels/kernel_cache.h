#pragma once

#include <filesystem>

#include "kernels/catalogue.h"

namespace misfit::kernels {

/// The family with a memory: solved kernels are kept as kernel-table files in `folder`, which is made when there is something
/// to keep, and taken from there when asked for again. The kernels are the same bit for bit. A file that is damaged, or not
/// what its name says, is solved for anew and replaced; where nothing can be kept the family just solves. Safe against others
/// that use the folder at the same time. A family that is not costly is returned as it is, and so is any when `folder` is
/// empty.
KernelFamily cached(KernelFamily family, const std::filesystem::path& folder);

}  // namespace misfit::kernels
