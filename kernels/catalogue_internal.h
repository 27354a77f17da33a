#pragma once

#include <vector>

#include "kernels/catalogue.h"

namespace misfit::kernels {

/// The families of kernel_catalogue(), for tests that put a cache before their solvers.
std::vector<KernelFamily>& changeable_catalogue();

}  // namespace misfit::kernels
