#include "imager/primary_beam.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

#include "imager/constants.h"
#include "imager/horizon.h"
#include "imager/parallel.h"

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

/// Shares of the same dishes at nearly the same frequency as one, with weights that add up to 1.
std::vector<BeamShare> taken_together(const std::vector<BeamShare>& shares) {
  constexpr double apart = 1e-3;  // relative
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

/// The beam from its axis to a radius, at points close enough that a cubic through four of them is right to 1e-10 in the main
/// lobe.
class RadialTable {
 public:
  RadialTable(const PrimaryBeam& beam, double reach, int threads) : reach_(reach), value_(points + 3) {
    parallel_for(value_.size(), threads, [&](std::size_t i) {
      value_[i] = beam.power(std::abs(static_cast<double>(i) - 1) * step());  // even about the axis
    });
  }

  /// At sin θ up to the reach.
  double operator()(double sine) const {
    const double place = sine / step();
    const int cell = std::min(static_cast<int>(place), points - 1);
    const double t = place - cell;
    const double* const v = value_.data() + cell;  // at −1, 0, 1, 2
    return -t * (t - 1) * (t - 2) / 6 * v[0] + (t + 1) * (t - 1) * (t - 2) / 2 * v[1] - (t + 1) * t * (t - 2) / 2 * v[2] +
           (t + 1) * t * (t - 1) / 6 * v[3];
  }

 private:
  static constexpr int points = 1024;
  double step() const { return reach_ / points; }

  double reach_;
  std::vector<double> value_;  ///< [point + 1]
};

/// A direction as a vector towards it: east, north, and to the phase centre.
struct Towards {
  double l, m, n;
  explicit Towards(DirectionCosines at) : l(at.l), m(at.m), n(1 + n_minus_1(at)) {}
};

/// sin θ of the angle between two; more than 1 where they are farther apart than 90°. From the chord, which keeps small ones.
double sine_between(const Towards& a, const Towards& b) {
  const double chord2 = (a.l - b.l) * (a.l - b.l) + (a.m - b.m) * (a.m - b.m) + (a.n - b.n) * (a.n - b.n);
  return chord2 > 2 ? 2 : std::sqrt(chord2 * (1 - chord2 / 4));
}

}  // namespace

double voltage_pattern(const Dish& dish, double sin_per_wavelength) {
  const double x = pi * dish.diameter_m * sin_per_wavelength, b = dish.blockage_m / dish.diameter_m;
  return b == 0 ? jinc(x) : (jinc(x) - b * b * jinc(b * x)) / (1 - b * b);
}

PrimaryBeam::PrimaryBeam(const std::vector<BeamShare>& shares) : shares_(taken_together(shares)) {
  double most = 0;  // D/λ
  for (const BeamShare& s : shares_)
    most = std::max(most, std::max(s.one.diameter_m, s.other.diameter_m) * s.frequency_hz / speed_of_light_m_s);
  narrowest_ = 1 / most;
}

double PrimaryBeam::power(double sine) const {
  double sum = 0;
  for (const BeamShare& s : shares_) {
    const double per_wavelength = sine * s.frequency_hz / speed_of_light_m_s;
    const double one = voltage_pattern(s.one, per_wavelength);
    sum += s.weight * one * (s.other == s.one ? one : voltage_pattern(s.other, per_wavelength));
  }
  return sum;
}

double PrimaryBeam::sine_at(double level) const {
  const double step = 0.02 * narrowest_;  // of which the narrowest main lobe has 60
  double before = 0, after = 0;
  while (after < 1 && power(after) > level) {
    before = after;
    after = std::min(1.0, after + step);
  }
  if (power(after) > level) return 1;
  for (int halvings = 0; halvings < 60; ++halvings) {
    const double middle = (before + after) / 2;
    (power(middle) > level ? before : after) = middle;
  }
  return after;
}

double PrimaryBeam::half_power_width_rad() const {
  return 2 * std::asin(sine_at(0.5));
}

Image primary_beam_image(const PrimaryBeam& beam, const ImageGeometry& geometry, const BeamOnImage& view) {
  if (!(view.limit > 0 && view.limit < 1))
    throw std::invalid_argument("limit of a primary beam " + std::to_string(view.limit) + "; expected more than 0, below 1");
  const double reach = beam.sine_at(view.limit);
  const RadialTable table(beam, reach, view.threads);
  const Towards axis(view.pointing);
  Image image(geometry.width, geometry.height);
  parallel_for(static_cast<std::size_t>(geometry.height), view.threads, [&](std::size_t r) {
    const int row = static_cast<int>(r);
    for (int column = 0; column < geometry.width; ++column) {
      const double sine = sine_between(Towards(geometry.at(row, column)), axis);
      image.at(row, column) = sine <= reach ? table(sine) : no_value;  // beyond the horizon it is NaN
    }
  });
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
