#include "kernels/version.h"
#include "tools/python/bindings.h"

PYBIND11_MODULE(_misfit, m) {
  m.doc() = "What the package misfit is made of, compiled.";
  m.attr("__version__") = MISFIT_VERSION;
  misfit::python::add_kernel(m);
  misfit::python::add_transforms(m);
  misfit::python::add_clean(m);
}
