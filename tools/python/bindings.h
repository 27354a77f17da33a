#pragma once

#include <pybind11/pybind11.h>

namespace misfit::python {

/// Each adds to the module _misfit what a file beside this one binds. Functions have no defaults and no descriptions: those are
/// of the functions in misfit/ that call them.

/// Kernel, kernel(), read_kernel() and kernel_names().
void add_kernel(pybind11::module_& m);

/// Transform, which misfit/_transforms.py plans and uses.
void add_transforms(pybind11::module_& m);

/// clean().
void add_clean(pybind11::module_& m);

}  // namespace misfit::python
