#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "imager/arrays/array_transform.h"

namespace misfit::python {

/// An option's value. Throws a Python TypeError that names the option where the value is of another type.
template <typename T>
T option(const pybind11::dict& options, const char* name) {
  try {
    return options[name].cast<T>();
  } catch (const pybind11::cast_error&) {
    throw pybind11::type_error(std::string(name) + " is " + pybind11::repr(options[name]).cast<std::string>() +
                               ", expected another type, or a value within its range");
  }
}

/// Arrays that say where samples lie; they must outlive what is made of them.
struct CoordinateArrays {
  const pybind11::object& uvw;  ///< float64
  std::vector<double> frequency_hz;
  const pybind11::object& mask;  ///< uint8, or None
};

/// The coordinates with the signs of flip_u, flip_v and flip_w, and without w unless do_wgridding.
imager::ArrayCoordinates coordinates_of(CoordinateArrays arrays, const pybind11::dict& options);

/// Options by the names of the functions in misfit/_transforms.py, each of which must be there. `kernel` is a Kernel, or a name
/// of the catalogue, whose solved functions are kept in the user's cache.
imager::ArrayTransformOptions transform_options(const pybind11::dict& options);

/// The family that `kernel` is: a name, or a Kernel alone.
kernels::KernelFamily family_of(const pybind11::handle& kernel);

}  // namespace misfit::python
