#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <string>
#include <utility>

#include "imager/arrays/array_clean.h"
#include "tools/python/array_options.h"
#include "tools/python/arrays.h"
#include "tools/python/bindings.h"
#include "tools/python/image_arrays.h"

namespace misfit::python {
namespace {

namespace py = pybind11;
using namespace misfit::imager;

/// Arrays of images [x][y] that go into CLEAN, or None.
struct ImagesIn {
  py::object mask;         ///< float64
  py::object start_model;  ///< float64, Jy/pixel
};

CleanOptions clean_options(const py::dict& options) {
  CleanOptions clean;
  clean.max_iterations = option<int>(options, "niter");
  clean.gain = option<double>(options, "gain");
  clean.threshold_jy = option<double>(options, "threshold");
  clean.nsigma = option<double>(options, "nsigma");
  clean.cycle_factor = option<double>(options, "cyclefactor");
  clean.min_psf_fraction = option<double>(options, "minpsffraction");
  clean.max_psf_fraction = option<double>(options, "maxpsffraction");
  clean.cycle_iterations = option<int>(options, "cycleniter");
  clean.max_major_cycles = option<int>(options, "nmajor");
  if (option<bool>(options, "automask")) clean.automask.emplace();
  return clean;
}

DeconvolverChoice deconvolver(const py::dict& options) {
  DeconvolverChoice choice;
  choice.name = option<std::string>(options, "deconvolver");
  choice.small_scale_bias = option<double>(options, "smallscalebias");
  choice.scale_pixels.clear();
  for (const double scale : option<std::vector<double>>(options, "scales"))
    choice.scale_pixels.push_back(tclean_scale_width * scale);
  return choice;
}

Image mask_of(const py::object& mask) {
  const Strided<const double> table = table_of<double>(mask);
  Image image(static_cast<int>(table.columns), static_cast<int>(table.rows));
  for (std::size_t row = 0; row < table.rows; ++row)
    for (std::size_t column = 0; column < table.columns; ++column)
      image.at(static_cast<int>(row), static_cast<int>(column)) = table.at(row, column);
  return image;
}

py::dict report_of(const ArrayClean& cleaned) {
  const MajorCycle& end = cleaned.report.final_state();
  py::dict report;
  report["iterations"] = cleaned.report.iterations;
  report["major_cycles"] = cleaned.report.cycles.size() - 1;
  report["stop_code"] = static_cast<int>(cleaned.report.stop);
  report["stop_reason"] = cleaned.report.stop_reason;
  report["peak_residual_jy"] = end.peak_residual_jy;
  report["rms_jy"] = end.rms_jy;
  report["model_flux_jy"] = end.model_flux_jy;
  report["expected_error"] = cleaned.expected_error;
  report["samples_used"] = cleaned.sums.used;
  report["samples_outside_grid"] = cleaned.sums.outside_grid;
  report["sum_of_weights"] = cleaned.sums.weight;
  return report;
}

template <typename Real>
ArrayClean cleaned(const CoordinateArrays& arrays, const py::array& visibility, const py::object& weight,
                   const ImagesIn& images, const py::dict& given) {
  const ArrayCoordinates at = coordinates_of(arrays, given);
  const ArrayValues<Real> values{table_of<std::complex<Real>>(visibility), table_of<Real>(weight)};
  ArrayCleanOptions options{transform_options(given), clean_options(given), deconvolver(given),
                            table_of<double>(images.start_model)};
  Image mask;
  if (!images.mask.is_none()) {
    mask = mask_of(images.mask);
    options.clean.mask = &mask;
  }
  return without_gil([&] { return clean_arrays(options, at, values); });
}

/// Returns the images by name, and CLEAN's report.
py::dict clean(const py::object& uvw, std::vector<double> frequency_hz, const py::object& mask, const py::array& visibility,
               const py::object& weight, const std::pair<py::object, py::object>& images, const py::dict& options) {
  const CoordinateArrays arrays{uvw, std::move(frequency_hz), mask};
  const ImagesIn in{images.first, images.second};
  ArrayClean made = py::isinstance<py::array_t<std::complex<float>>>(visibility)
                        ? cleaned<float>(arrays, visibility, weight, in, options)
                        : cleaned<double>(arrays, visibility, weight, in, options);
  py::dict result;
  result["report"] = report_of(made);
  result["beam"] = py::make_tuple(made.beam.major_rad, made.beam.minor_rad, made.beam.position_angle_rad);
  if (!made.mask.pixel.empty()) result["mask"] = handed_over(std::move(made.mask));
  result["image"] = handed_over(std::move(made.restored));
  result["residual"] = handed_over(std::move(made.residual));
  result["model"] = handed_over(std::move(made.model));
  result["psf"] = handed_over(std::move(made.psf));
  return result;
}

}  // namespace

void add_clean(py::module_& m) {
  m.def("clean", clean);
}

}  // namespace misfit::python
