#include "tools/python/image_arrays.h"

#include <memory>
#include <utility>
#include <vector>

namespace misfit::python {

namespace py = pybind11;

py::array_t<double> handed_over(imager::Image image) {
  const py::ssize_t rows = image.height, columns = image.width;
  auto pixels = std::make_unique<std::vector<double>>(std::move(image.pixel));
  const double* const data = pixels->data();
  const py::capsule owner(pixels.release(), [](void* memory) { delete static_cast<std::vector<double>*>(memory); });
  return py::array_t<double>({rows, columns}, data, owner);
}

}  // namespace misfit::python
