#pragma once

#include <string>

#include "kernels/kernel.h"

namespace misfit::python {

/// The gridding function that `misfit.kernel(name, width, x0)` returns: of the catalogue, or from the user's cache. Other
/// Python threads run meanwhile, and Ctrl-C ends the wait. A kernel in Python is a kernels::Kernel, which add_kernel()
/// declares, so that functions can have one as an argument. Throws as kernels::kernel_family() and KernelFamily::make() do.
kernels::Kernel named_kernel(const std::string& name, int width, double x0);

}  // namespace misfit::python
