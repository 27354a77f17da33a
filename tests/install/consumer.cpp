// One header and one function of each installed library, in C++17.
#include <cmath>

#include "imager/fits_image.h"
#include "imager/geometry.h"
#include "ms_io/measurement_set.h"

int main() {
  const misfit::imager::SkyDirection centre{1.0, 0.5, "FK5"};
  const misfit::imager::DirectionCosines here = misfit::imager::direction_cosines(centre, centre);
  return std::abs(here.l) + std::abs(here.m) < 1e-15 ? 0 : 1;
}
