#include "imager/beams/primary_beam.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

#include "imager/beams/beam_tables.h"
#include "imager/beams/radial_function.h"
#include "imager/data/horizon.h"
#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

constexpr double apart_if_turned = 8;

bool all_round(const std::vector<BeamShare>& shares) {
  return std::all_of(shares.begin(), shares.end(), [](const BeamShare& s) { return s.one->is_round() && s.other->is_round(); });
}

void check(const BeamShare& share) {
  if (!(share.frequency_hz > 0 && std::isfinite(share.frequency_hz)))
    throw std::invalid_argument("primary beam at " + std::to_string(share.frequency_hz) + " Hz; expected a positive number");
  if (!(share.weight >= 0 && std::isfinite(share.weight)))
    throw std::invalid_argument("share of a primary beam with weight " + std::to_string(share.weight) + "; expected 0 or more");
}

/// Joins shares of the same patterns, turned alike to a degree, at frequencies less than `apart` of themselves from each other,
/// with weights that add up to 1; in the order of the first of each.
std::vector<BeamShare> taken_together(const std::vector<BeamShare>& shares, double apart) {
  constexpr double turn_step = pi / 180;
  using Key = std::tuple<const VoltagePattern*, const VoltagePattern*, long, long>;
  std::map<Key, std::size_t> place;
  std::vector<BeamShare> together;  // Σ frequency · weight in place of the frequency
  double weight = 0;
  for (const BeamShare& s : shares) {
    check(s);
    if (s.weight == 0) continue;
    weight += s.weight;
    const double turn_rad = s.one->is_round() && s.other->is_round() ? 0 : s.turn_rad;
    const Key key{s.one.get(), s.other.get(), std::lround(std::log(s.frequency_hz) / apart), std::lround(turn_rad / turn_step)};
    const auto [at, is_new] = place.insert({key, together.size()});
    if (is_new) together.push_back({s.one, s.other, 0, 0});
    together[at->second].frequency_hz += s.frequency_hz * s.weight;
    together[at->second].turn_rad += turn_rad * s.weight;
    together[at->second].weight += s.weight;
  }
  if (!(weight > 0)) throw std::invalid_argument("primary beam of weight 0; expected shares with weights above 0");
  for (BeamShare& sum : together) {
    sum.frequency_hz /= sum.weight;
    sum.turn_rad /= sum.weight;
    sum.weight /= weight;
  }
  return together;
}

}  // namespace

double power(const BeamShare& share, double sine) {
  const double one = share.one->voltage(sine, share.frequency_hz);
  return one * (share.other == share.one ? one : share.other->voltage(sine, share.frequency_hz));
}

PrimaryBeam::PrimaryBeam(const std::vector<BeamShare>& shares, double apart)
    : apart_((all_round(shares) ? 1 : apart_if_turned) * apart), shares_(taken_together(shares, apart_)) {
  for (const BeamShare& s : shares_)
    for (const Pattern& pattern : {s.one, s.other}) narrowest_ = std::min(narrowest_, pattern->detail_sine(s.frequency_hz));
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
    for (const Pattern& pattern : {s.one, s.other}) widest = std::max(widest, pattern->main_lobe_sine(s.frequency_hz));
  return widest;
}

bool PrimaryBeam::is_round() const {
  return all_round(shares_);
}

double PrimaryBeam::known_sine() const {
  double nearest = 1;
  for (const BeamShare& s : shares_)
    for (const Pattern& pattern : {s.one, s.other})
      if (!pattern->is_round()) nearest = std::min(nearest, pattern->main_lobe_sine(s.frequency_hz));
  return nearest;
}

void require_limit(const BeamOnImage& view) {
  if (!(view.limit > 0 && view.limit < 1))
    throw std::invalid_argument("limit of a primary beam " + std::to_string(view.limit) + "; expected more than 0, below 1");
}

Image primary_beam_image(const PrimaryBeam& beam, const ImageGeometry& geometry, const BeamOnImage& view) {
  require_limit(view);
  const BeamTables tables(
      beam, {[](double) { return 1; }}, view.limit, [](const double* value) { return value[0]; }, view.threads);
  Image image(geometry.width, geometry.height);
  std::fill(image.pixel.begin(), image.pixel.end(), no_value);
  tables.for_each_pixel(view.pointing, geometry, view.threads,
                        [&](std::size_t pixel, const double* value) { image.pixel[pixel] = value[0]; });
  return image;
}

Image corrected(const Image& image, const Image& beam) {
  if (image.width != beam.width || image.height != beam.height)
    throw std::invalid_argument("image of " + std::to_string(image.width) + " × " + std::to_string(image.height) +
                                " pixels with a primary beam of " + std::to_string(beam.width) + " × " +
                                std::to_string(beam.height) + "; expected one size");
  Image quotient = image;
  for (std::size_t i = 0; i < quotient.pixel.size(); ++i) quotient.pixel[i] /= beam.pixel[i];
  return quotient;
}

}  // namespace misfit::imager
