#pragma once

#include <pybind11/numpy.h>

#include "imager/data/image.h"

namespace misfit::python {

/// An image as an array [row][column] that owns the same memory.
pybind11::array_t<double> handed_over(imager::Image image);

}  // namespace misfit::python
