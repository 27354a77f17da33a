#include "tools/python/array_options.h"

#include <pybind11/stl.h>

#include <string>

#include "kernels/kernel_cache.h"
#include "tools/kernel_choice/cache_folder.h"
#include "tools/python/arrays.h"
#include "tools/python/interruptible.h"

namespace misfit::python {
namespace {

namespace py = pybind11;

/// The family, with solving that Ctrl-C ends, whether or not the calling thread holds Python's lock.
kernels::KernelFamily interruptible(kernels::KernelFamily family) {
  family.solve = [inner = family.solve](int width, double x0) {
    const py::gil_scoped_acquire python;
    return interruptibly<kernels::Kernel>([inner, width, x0] { return inner(width, x0); });
  };
  return family;
}

double sign(const py::dict& options, const char* flip) {
  return option<bool>(options, flip) ? -1 : 1;
}

}  // namespace

imager::ArrayCoordinates coordinates_of(CoordinateArrays arrays, const py::dict& options) {
  imager::ArrayCoordinates at;
  at.uvw_m = table_of<double>(arrays.uvw);
  at.frequency_hz = std::move(arrays.frequency_hz);
  at.mask = table_of<std::uint8_t>(arrays.mask);
  at.u_sign = sign(options, "flip_u");
  at.v_sign = sign(options, "flip_v");
  at.w_sign = option<bool>(options, "do_wgridding") ? sign(options, "flip_w") : 0;
  return at;
}

kernels::KernelFamily family_of(const py::handle& kernel) {
  if (py::isinstance<py::str>(kernel))
    return interruptible(kernels::cached(kernels::kernel_family(kernel.cast<std::string>()), tools::default_cache_folder()));
  if (py::isinstance<kernels::Kernel>(kernel)) return kernels::family_of(kernel.cast<const kernels::Kernel&>());
  throw py::type_error("kernel is of type " + py::str(py::type::of(kernel).attr("__name__")).cast<std::string>() +
                       ", expected a name or a misfit.Kernel");
}

imager::ArrayTransformOptions transform_options(const py::dict& options) {
  imager::ArrayTransformOptions o;
  o.image = {option<int>(options, "npix_x"),       option<int>(options, "npix_y"),      option<double>(options, "pixsize_x"),
             option<double>(options, "pixsize_y"), option<double>(options, "center_x"), option<double>(options, "center_y")};
  o.accuracy = option<double>(options, "epsilon");
  o.divide_by_n = option<bool>(options, "divide_by_n");
  o.least_padding = option<double>(options, "sigma_min");
  o.most_padding = option<double>(options, "sigma_max");
  o.kernel = family_of(options["kernel"]);
  o.kernel_width = option<int>(options, "kernel_width");
  if (option<bool>(options, "in_double")) o.precision = imager::Precision::double_precision;
  o.threads = option<int>(options, "nthreads");
  return o;
}

}  // namespace misfit::python
