#include "tools/python/kernel.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>

#include "kernels/catalogue.h"
#include "kernels/kernel_cache.h"
#include "kernels/kernel_table.h"
#include "kernels/polynomial_taps.h"
#include "kernels/sampled_function.h"
#include "tools/kernel_choice/cache_folder.h"
#include "tools/python/bindings.h"
#include "tools/python/interruptible.h"
#include "tools/python/kernel_text.h"

namespace misfit::python {

namespace py = pybind11;
using kernels::Kernel;

kernels::Kernel named_kernel(const std::string& name, int width, double x0) {
  const kernels::KernelFamily family = kernels::cached(kernels::kernel_family(name), tools::default_cache_folder());
  return interruptibly<Kernel>([family, width, x0] { return family.make(width, x0); });
}

namespace {

/// An array of all that numpy calls safe to cast to doubles; arrays of doubles are not copied.
using Input = py::array_t<double, py::array::c_style>;

/// A Python number for an array without axes, as numpy's own functions return.
py::object unwrapped(const py::array& array) {
  return array.ndim() == 0 ? array[py::tuple()].cast<py::object>() : py::object(array);
}

/// `value` ∈ [−½, ½], or std::invalid_argument that names it.
double inside(double value, const char* what, const char* meaning) {
  if (std::abs(value) <= 0.5) return value;
  std::ostringstream message;
  message << what << " = " << value << " not in [-0.5, 0.5], " << meaning;
  throw std::invalid_argument(message.str());
}

constexpr py::ssize_t block = 256;  // results of so many fit the processor's caches

/// An array of the input's shape, with the results of `function` for each block of numbers, [first, end) to `to`.
template <typename Function>
py::object mapped(const Input& input, const Function& function) {
  py::array_t<double> result(std::vector<py::ssize_t>(input.shape(), input.shape() + input.ndim()));
  const double* const from = input.data();
  double* const to = result.mutable_data();
  in_blocks(input.size(), block, [&](auto begin, auto end) { function(from + begin, from + end, to + begin); });
  return unwrapped(result);
}

py::object values(const Kernel& kernel, const Input& u) {
  return mapped(u, [&](const double* first, const double* end, double* to) {
    Eigen::Map<Eigen::VectorXd>(to, end - first) =
        kernels::function_values(kernel.polynomial, Eigen::Map<const Eigen::VectorXd>(first, end - first));
  });
}

py::array_t<double> taps(const Kernel& kernel, const Input& t) {
  std::vector<py::ssize_t> shape(t.shape(), t.shape() + t.ndim());
  const py::ssize_t width = kernel.width();
  shape.push_back(width);
  py::array_t<double> result(shape);
  const double* const from = t.data();
  double* const to = result.mutable_data();
  const kernels::PlainPolynomial<double> polynomial(kernel.polynomial);
  in_blocks(t.size(), block, [&](auto begin, auto end) {
    for (auto i = begin; i < end; ++i)
      polynomial.taps(inside(from[i], "t", "cells from the middle of the visibility's own"), to + i * width);
  });
  return result;
}

/// A function of the image, h or ℓ.
py::object over_image(const Input& x, const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& function) {
  return mapped(x, [&](const double* first, const double* end, double* to) {
    std::for_each(first, end, [](double at) { inside(at, "x", "pixels from the phase centre over the size of the FFT"); });
    const Eigen::Index count = end - first;
    Eigen::Map<Eigen::VectorXd>(to, count) = function(Eigen::Map<const Eigen::VectorXd>(first, count));
  });
}

py::object correction(const Kernel& kernel, const Input& x) {
  return over_image(x, [&](const Eigen::VectorXd& at) { return kernels::optimal_correction(kernel.polynomial, at); });
}

py::object map_error(const Kernel& kernel, const Input& x) {
  return over_image(x, [&](const Eigen::VectorXd& at) { return kernels::map_error(kernel.polynomial, at); });
}

/// The numbers themselves, read-only; they live as long as the array or the kernel.
py::array coefficients(const py::object& self) {
  const Eigen::MatrixXd& coefficient = self.cast<const Kernel&>().polynomial.coefficient;
  constexpr py::ssize_t step = sizeof(double);
  py::array_t<double> view({coefficient.rows(), coefficient.cols()}, {step, step * coefficient.rows()}, coefficient.data(),
                           self);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

std::string description(const Kernel& kernel) {
  std::ostringstream text;
  text << "<misfit.Kernel " << kernel.name << ", width " << kernel.width() << ", x0 " << kernel.x0 << ", mean error "
       << kernel.misfit.mean << ", largest " << kernel.misfit.max << ", degree " << kernel.polynomial.degree() << ">";
  return text.str();
}

/// Calls `work` on a file; its errors become OSError.
template <typename Work>
auto on_file(PyObject* error_type, const Work& work) {
  try {
    const py::gil_scoped_release others_run;
    return work();
  } catch (const std::runtime_error& error) {
    PyErr_SetString(error_type, error.what());
  }
  throw py::error_already_set();
}

Kernel read_kernel(const std::filesystem::path& path) {
  std::error_code ignored;
  PyObject* const error_type = std::filesystem::exists(path, ignored) ? PyExc_OSError : PyExc_FileNotFoundError;
  return on_file(error_type, [&] { return kernels::read_intact_kernel_table(path).kernel; });
}

void write(const Kernel& kernel, const std::filesystem::path& path, int sampling, int interpolation) {
  on_file(PyExc_OSError, [&] { kernels::write_kernel_table(kernel, kernels::TableSampling{sampling, interpolation}, path); });
}

std::vector<std::string> kernel_names() {
  std::vector<std::string> names;
  for (const kernels::KernelFamily& family : kernels::kernel_catalogue()) names.push_back(family.name);
  return names;
}

}  // namespace

void add_kernel(py::module_& m) {
  py::options options;
  options.disable_function_signatures();  // each text has its own, which Python's help() and inspect understand
  py::class_<Kernel>(m, "Kernel", text::kernel)
      .def_readonly("name", &Kernel::name, text::name)
      .def_property_readonly("width", &Kernel::width, text::width)
      .def_readonly("x0", &Kernel::x0, text::x0)
      .def_property_readonly(
          "mean_error", [](const Kernel& k) { return k.misfit.mean; }, text::mean_error)
      .def_property_readonly(
          "max_error", [](const Kernel& k) { return k.misfit.max; }, text::max_error)
      .def_property_readonly(
          "degree", [](const Kernel& k) { return k.polynomial.degree(); }, text::degree)
      .def_property_readonly("coefficients", coefficients, text::coefficients)
      .def("__call__", values, py::arg("u"), text::call)
      .def("taps", taps, py::arg("t"), text::taps)
      .def("correction", correction, py::arg("x"), text::correction)
      .def("map_error", map_error, py::arg("x"), text::map_error)
      .def("write", write, py::arg("path"), py::arg("sampling") = 128, py::arg("interpolation") = 3, text::write)
      .def("__repr__", description);
  m.attr("Kernel").attr("__module__") = "misfit";
  m.def("kernel", named_kernel, py::arg("name"), py::arg("width"), py::arg("x0"));
  m.def("read_kernel", read_kernel, py::arg("path"));
  m.def("kernel_names", kernel_names);
}

}  // namespace misfit::python
