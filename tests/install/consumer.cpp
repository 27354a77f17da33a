// Something of each installed library, in C++17: plan a transform, predict a source, and refuse a set that does not exist.
#include <cmath>
#include <stdexcept>

#include "imager/plan/gridding_plan.h"
#include "kernels/catalogue.h"
#include "ms_io/measurement_set.h"

int main() {
  using namespace misfit;
  if (!(kernels::kernel_family("least-misfit").make(7, 0.25).misfit.mean < 1.5e-14)) return 1;

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

  try {
    ms_io::MeasurementSet("no such set", {}, "DATA");
  } catch (const std::runtime_error&) {
    return 0;
  }
  return 3;
}
