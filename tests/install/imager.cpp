// Plans a transform, and predicts a source.
#include <cmath>

#include "imager/plan/gridding_plan.h"

int main() {
  using namespace misfit::imager;
  GriddingRequest request;
  request.geometry.width = request.geometry.height = 64;
  request.geometry.cell_rad = 1e-6;
  request.accuracy = 1e-6;
  const auto transform = make_coplanar_transform(plan_gridding(request).options);
  Image model(64, 64);
  model.at(32, 32) = 1;  // at the phase centre: V = 1 everywhere
  SampleCoordinates somewhere;
  somewhere.uvw_m = {1e4, -2e4, 0};
  somewhere.frequency_hz = {1e9};
  return std::abs(transform->predict(model)->at(somewhere)[0] - 1.0) < 1e-5 ? 0 : 1;
}
