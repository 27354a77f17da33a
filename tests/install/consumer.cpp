// Something of each installed library, in C++17: plan a transform, predict a source, grid and degrid a visibility as casacore
// would, and refuse a set that does not exist.
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "imager/plan/gridding_plan.h"
#include "kernels/catalogue.h"
#include "kernels/kernel_table.h"
#include "ms_io/measurement_set.h"
#include "tools/hosts/casacore_gridder.h"
#include "tools/hosts/convolve_gridder_table.h"

/// The visibility 1 put on the grid and taken from there again, which is (Σ C²)² in two dimensions: 0 < … < 1.
bool grids(casacore::Gridder<casacore::Double, casacore::Complex>&& gridder) {
  casacore::Array<casacore::Complex> grid(casacore::IPosition(2, 32, 32), casacore::Complex(0));
  casacore::Complex value;
  const casacore::Vector<double> position(2, 16.3);
  if (!gridder.grid(grid, position, casacore::Complex(1)) || !gridder.degrid(grid, position, value)) return false;
  return value.real() > 0.01 && value.real() < 1 && std::abs(value.imag()) < 1e-6;
}

int main() {
  using namespace misfit;
  const kernels::Kernel kernel = kernels::kernel_family("least-misfit").make(7, 0.25);
  if (!(kernel.misfit.mean < 1.5e-14)) return 1;

  imager::GriddingRequest request;
  request.geometry.width = request.geometry.height = 64;
  request.geometry.cell_rad = 1e-6;
  request.accuracy = 1e-6;
  const auto transform = imager::make_plane_transform(imager::plan_gridding(request).options);
  imager::Image model(64, 64);
  model.at(32, 32) = 1;  // at the phase centre: V = 1 everywhere
  imager::SampleCoordinates somewhere;
  somewhere.uvw_m = {1e4, -2e4, 0};
  somewhere.frequency_hz = {1e9};
  if (!(std::abs(transform->predict(model)->at(somewhere)[0] - 1.0) < 1e-5)) return 2;

  const char* const file = "kernel.fits";
  kernels::write_kernel_table(kernel, kernels::TableSampling{}, file);
  const casacore::IPosition shape(2, 32, 32);
  const casacore::Vector<double> scale(2, 1.0), offset(2, 0.0);
  const bool gridded = grids(hosts::CasacoreGridder(file, shape, scale, offset)) &&
                       grids(hosts::ConvolveGridderTable(file, shape, scale, offset));
  std::remove(file);
  if (!gridded) return 4;

  try {
    ms_io::MeasurementSet("no such set", {}, "DATA");
  } catch (const std::runtime_error&) {
    return 0;
  }
  return 3;
}
