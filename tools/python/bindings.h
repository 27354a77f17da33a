#pragma once

#include <pybind11/pybind11.h>

namespace misfit::python {

/// Each adds the bindings of a file beside this one to the module _misfit. Bound functions have no defaults and no
/// descriptions: the functions in misfit/ that call them do.

/// Kernel, kernel(), read_kernel() and kernel_names().
void add_kernel(pybind11::module_& m);

/// Transform, which misfit/_transforms.py plans and uses.
void add_transforms(pybind11::module_& m);

/// clean().
void add_clean(pybind11::module_& m);

}  // namespace misfit::python
