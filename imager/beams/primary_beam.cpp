#include "imager/beams/primary_beam.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

#include "imager/beams/radial_function.h"
#include "imager/data/horizon.h"
#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

/// 2 J₁(x)/x, even, and 1 at 0; below 0.01 its series, whose next term is 1e-16.
double jinc(double x) {
  const double square = x * x;
  return std::abs(x) < 0.01 ? 1 - square / 8 + square * square / 192 : 2 * ::j1(x) / x;
}

void check(const BeamShare& share) {
  for (const Dish& dish : {share.one, share.other})
    if (!(dish.blockage_m >= 0 && dish.blockage_m < dish.diameter_m && std::isfinite(dish.diameter_m)))
      throw std::invalid_argument("dish of " + std::to_string(dish.diameter_m) + " m with a blockage of " +
                                  std::to_string(dish.blockage_m) + " m; expected 0 ≤ blockage < diameter");
  if (!(share.frequency_hz > 0 && std::isfinite(share.frequency_hz)))
    throw std::invalid_argument("primary beam at " + std::to_string(share.frequency_hz) + " Hz; expected a positive number");
  if (!(share.weight >= 0 && std::isfinite(share.weight)))
    throw std::invalid_argument("share of a primary beam with weight " + std::to_string(share.weight) + "; expected 0 or more");
}

/// Shares of the same dishes at nearly the same frequency, less than `apart` of it, as one, with weights that add up to 1.
std::vector<BeamShare> taken_together(const std::vector<BeamShare>& shares, double apart) {
  using Key = std::tuple<double, double, double, double, long>;
  std::map<Key, BeamShare> sums;  // Σ frequency · weight in place of the frequency
  double weight = 0;
  for (const BeamShare& s : shares) {
    check(s);
    if (s.weight == 0) continue;
    weight += s.weight;
    const Key key{s.one.diameter_m, s.one.blockage_m, s.other.diameter_m, s.other.blockage_m,
                  std::lround(std::log(s.frequency_hz) / apart)};
    BeamShare& sum = sums.insert({key, {s.one, s.other, 0, 0}}).first->second;
    sum.frequency_hz += s.frequency_hz * s.weight;
    sum.weight += s.weight;
  }
  if (!(weight > 0)) throw std::invalid_argument("primary beam of weight 0; expected shares with weights above 0");
  std::vector<BeamShare> together;
  for (auto& [key, sum] : sums) together.push_back({sum.one, sum.other, sum.frequency_hz / sum.weight, sum.weight / weight});
  return together;
}

}  // namespace

double voltage_pattern(const Dish& dish, double sin_per_wavelength) {
  const double x = pi * dish.diameter_m * sin_per_wavelength, b = dish.blockage_m / dish.diameter_m;
  return b == 0 ? jinc(x) : (jinc(x) - b * b * jinc(b * x)) / (1 - b * b);
}

double first_null_per_m(const Dish& dish) {
  const double beyond = 4 / (pi * dish.diameter_m);  // x = 4, where that of an open dish is at 3.83 and that of a ring at 2.40
  return beyond * first_sine_at(0, 0.05, [&](double part) { return voltage_pattern(dish, part * beyond); });
}

double power(const BeamShare& share, double sine) {
  const double per_wavelength = sine * share.frequency_hz / speed_of_light_m_s;
  const double one = voltage_pattern(share.one, per_wavelength);
  return one * (share.other == share.one ? one : voltage_pattern(share.other, per_wavelength));
}

PrimaryBeam::PrimaryBeam(const std::vector<BeamShare>& shares, double apart) : shares_(taken_together(shares, apart)) {
  double most = 0;  // D/λ
  for (const BeamShare& s : shares_)
    most = std::max(most, std::max(s.one.diameter_m, s.other.diameter_m) * s.frequency_hz / speed_of_light_m_s);
  narrowest_ = 1 / most;
}

double PrimaryBeam::power(double sine) const {
  double sum = 0;
  for (const BeamShare& s : shares_) sum += s.weight * imager::power(s, sine);
  return sum;
}

double PrimaryBeam::sine_at(double level) const {
  return first_sine_at(level, step(), [this](double sine) { return power(sine); });
}

double PrimaryBeam::half_power_width_rad() const {
  return 2 * std::asin(sine_at(0.5));
}

double PrimaryBeam::main_lobe_sine() const {
  double widest = 0;
  for (const BeamShare& s : shares_)
    for (const Dish& dish : {s.one, s.other})
      widest = std::max(widest, first_null_per_m(dish) * speed_of_light_m_s / s.frequency_hz);
  return std::min(1.0, widest);
}

void require_limit(const BeamOnImage& view) {
  if (!(view.limit > 0 && view.limit < 1))
    throw std::invalid_argument("limit of a primary beam " + std::to_string(view.limit) + "; expected more than 0, below 1");
}

Image primary_beam_image(const PrimaryBeam& beam, const ImageGeometry& geometry, const BeamOnImage& view) {
  require_limit(view);
  const RadialTable table(beam.sine_at(view.limit), view.threads, [&](double sine) { return beam.power(sine); });
  Image image(geometry.width, geometry.height);
  std::fill(image.pixel.begin(), image.pixel.end(), no_value);
  for_each_within(table.reach(), view.pointing, geometry, view.threads,
                  [&](std::size_t pixel, double sine) { image.pixel[pixel] = table(sine); });
  return image;
}

Image corrected(const Image& image, const Image& beam) {
  if (image.width != beam.width || image.height != beam.height)
    throw std::invalid_argument("image of " + std::to_string(image.width) + " × " + std::to_string(image.height) +
                                " pixels with a primary beam of " + std::to_string(beam.width) + " × " +
                                std::to_string(beam.height));
  Image quotient = image;
  for (std::size_t i = 0; i < quotient.pixel.size(); ++i) quotient.pixel[i] /= beam.pixel[i];
  return quotient;
}

}  // namespace misfit::imager
