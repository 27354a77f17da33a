#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "imager/arrays/array_transform.h"
#include "tools/python/array_options.h"
#include "tools/python/arrays.h"
#include "tools/python/bindings.h"
#include "tools/python/image_arrays.h"

namespace misfit::python {
namespace {

namespace py = pybind11;
using namespace misfit::imager;

template <typename Real>
void copy(const Image& image, const Strided<Real>& into, int threads) {
  parallel_for(into.rows, threads, [&](std::size_t row) {
    const double* const from = image.row(static_cast<int>(row));
    for (std::size_t column = 0; column < into.columns; ++column) into.at(row, column) = static_cast<Real>(from[column]);
  });
}

/// The transform of one set of coordinates, both ways.
class TransformOfArrays {
 public:
  TransformOfArrays(py::object uvw, std::vector<double> frequency_hz, py::object mask, const py::dict& options)
      : uvw_(std::move(uvw)), mask_(std::move(mask)), at_(coordinates_of({uvw_, std::move(frequency_hz), mask_}, options)) {
    const ArrayTransformOptions read = transform_options(options);
    without_gil([&] { transform_.emplace(read, at_); });
  }
  TransformOfArrays(const TransformOfArrays&) = delete;  // the transform points to the coordinates
  TransformOfArrays& operator=(const TransformOfArrays&) = delete;

  /// The image, in `into` or an array of its own, and its expected error.
  template <typename Real>
  std::pair<py::array, double> image(const py::array& visibility, const py::object& weight, const py::object& into) const {
    const ArrayValues<Real> values{table_of<std::complex<Real>>(visibility), table_of<Real>(weight)};
    ArrayAdjoint made = without_gil([&] { return transform_->adjoint(values); });
    if (into.is_none() && std::is_same_v<Real, double>) return {handed_over(std::move(made.image)), made.expected_error};
    py::array array =
        into.is_none() ? py::array_t<Real>({made.image.height, made.image.width}) : py::reinterpret_borrow<py::array>(into);
    const Strided<Real> table = writable_table_of<Real>(array);
    without_gil([&] { copy(made.image, table, transform_->plan().options.threads); });
    return {array, made.expected_error};
  }

  template <typename Real>
  void predict(const py::array& model, const py::object& weight, py::array& into) const {
    const Strided<const Real> pixels = table_of<Real>(model), weights = table_of<Real>(weight);
    const Strided<std::complex<Real>> visibility = writable_table_of<std::complex<Real>>(into);
    without_gil([&] { transform_->predict(pixels, weights, visibility); });
  }

  std::pair<py::array, double> vis2dirty(const py::array& visibility, const py::object& weight, const py::object& into) const {
    return py::isinstance<py::array_t<std::complex<float>>>(visibility) ? image<float>(visibility, weight, into)
                                                                        : image<double>(visibility, weight, into);
  }
  void dirty2vis(const py::array& model, const py::object& weight, py::array into) const {
    py::isinstance<py::array_t<float>>(model) ? predict<float>(model, weight, into) : predict<double>(model, weight, into);
  }
  std::vector<std::tuple<std::string, std::string, std::string>> plan() const {
    std::vector<std::tuple<std::string, std::string, std::string>> lines;
    for (const Decision& d : decisions_of(transform_->plan())) lines.emplace_back(d.item, d.decision, d.because);
    return lines;
  }

 private:
  py::object uvw_, mask_;  ///< whose memory `at_` points to
  ArrayCoordinates at_;
  std::optional<ArrayTransform> transform_;
};

}  // namespace

void add_transforms(py::module_& m) {
  py::class_<TransformOfArrays>(m, "Transform")
      .def(py::init<py::object, std::vector<double>, py::object, const py::dict&>())
      .def("vis2dirty", &TransformOfArrays::vis2dirty)
      .def("dirty2vis", &TransformOfArrays::dirty2vis)
      .def("plan", &TransformOfArrays::plan);
}

}  // namespace misfit::python
