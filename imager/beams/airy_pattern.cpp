#include "imager/beams/airy_pattern.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "imager/beams/radial_function.h"
#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

/// 2 J₁(x)/x, even, and 1 at 0; below 0.01 its series, whose next term is 1e-16.
double jinc(double x) {
  const double square = x * x;
  return std::abs(x) < 0.01 ? 1 - square / 8 + square * square / 192 : 2 * ::j1(x) / x;
}

class AiryPattern : public VoltagePattern {
 public:
  explicit AiryPattern(const Dish& dish) : dish_(dish), null_per_m_(first_null_per_m(dish)) {}

  double voltage(double sine, double frequency_hz) const override {
    return airy_voltage(dish_, sine * frequency_hz / speed_of_light_m_s);
  }
  double main_lobe_sine(double frequency_hz) const override {
    return std::min(1.0, null_per_m_ * speed_of_light_m_s / frequency_hz);
  }
  double detail_sine(double frequency_hz) const override { return speed_of_light_m_s / frequency_hz / dish_.diameter_m; }

 private:
  Dish dish_;
  double null_per_m_;
};

}  // namespace

double airy_voltage(const Dish& dish, double sin_per_wavelength) {
  const double x = pi * dish.diameter_m * sin_per_wavelength, b = dish.blockage_m / dish.diameter_m;
  return b == 0 ? jinc(x) : (jinc(x) - b * b * jinc(b * x)) / (1 - b * b);
}

double first_null_per_m(const Dish& dish) {
  const double beyond = 4 / (pi * dish.diameter_m);  // x = 4, where that of an open dish is at 3.83 and that of a ring at 2.40
  return beyond * first_sine_at(0, 0.05, [&](double part) { return airy_voltage(dish, part * beyond); });
}

Pattern airy_pattern(const Dish& dish) {
  if (!(dish.blockage_m >= 0 && dish.blockage_m < dish.diameter_m && std::isfinite(dish.diameter_m)))
    throw std::invalid_argument("dish of " + std::to_string(dish.diameter_m) + " m with a blockage of " +
                                std::to_string(dish.blockage_m) + " m; expected 0 ≤ blockage < diameter");
  return std::make_shared<AiryPattern>(dish);
}

}  // namespace misfit::imager
