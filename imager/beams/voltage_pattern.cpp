#include "imager/beams/voltage_pattern.h"

#include <algorithm>
#include <cmath>

#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

constexpr double arcmin_rad = pi / (180 * 60), ghz = 1e9;

}  // namespace

std::string VoltagePattern::doubt(double) const {
  return "";
}

double arcmin_ghz(double sine, double frequency_hz) {
  return std::asin(std::min(1.0, sine)) / arcmin_rad * (frequency_hz / ghz);
}

double sine_of_arcmin_ghz(double product, double frequency_hz) {
  return std::sin(std::min(pi / 2, product * arcmin_rad / (frequency_hz / ghz)));
}

}  // namespace misfit::imager
