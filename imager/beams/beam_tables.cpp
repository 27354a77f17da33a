#include "imager/beams/beam_tables.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace misfit::imager {
namespace {

constexpr std::size_t most_factors = 8;

/// Shares that differ but for their turns, at their mean frequency.
struct TurnedShares {
  BeamShare all;  ///< Σ frequency · weight in place of the frequency
  std::vector<const BeamShare*> turned;
};

std::vector<TurnedShares> by_turn(const PrimaryBeam& beam) {
  using Key = std::tuple<const VoltagePattern*, const VoltagePattern*, long>;
  std::map<Key, std::size_t> place;
  std::vector<TurnedShares> groups;
  for (const BeamShare& s : beam.shares()) {
    const Key key{s.one.get(), s.other.get(), std::lround(std::log(s.frequency_hz) / beam.apart())};
    const auto [at, is_new] = place.insert({key, groups.size()});
    if (is_new) groups.push_back({{s.one, s.other, 0, 0}, {}});
    TurnedShares& group = groups[at->second];
    group.all.frequency_hz += s.frequency_hz * s.weight;
    group.all.weight += s.weight;
    group.turned.push_back(&s);
  }
  for (TurnedShares& group : groups) group.all.frequency_hz /= group.all.weight;
  return groups;
}

}  // namespace

BeamTables::BeamTables(const PrimaryBeam& beam, const std::vector<Factor>& factors, double limit, const Level& level,
                       int threads) {
  if (beam.is_round())
    make_round(beam, factors, limit, level, threads);
  else
    make_turned(beam, factors, limit, level, threads);
}

void BeamTables::make_round(const PrimaryBeam& beam, const std::vector<Factor>& factors, double limit, const Level& level,
                            int threads) {
  const auto sum = [&](std::size_t f, double sine) {
    double total = 0;
    for (const BeamShare& s : beam.shares()) total += s.weight * factors[f](s.frequency_hz) * power(s, sine);
    return total;
  };
  const double reach = first_sine_at(limit, beam.step(), [&](double sine) {
    double value[most_factors];
    for (std::size_t f = 0; f < factors.size(); ++f) value[f] = sum(f, sine);
    return level(value);
  });
  for (std::size_t f = 0; f < factors.size(); ++f)
    radial_.emplace_back(reach, threads, [&](double sine) { return sum(f, sine); });
}

void BeamTables::make_turned(const PrimaryBeam& beam, const std::vector<Factor>& factors, double limit, const Level& level,
                             int threads) {
  const double reach = beam.known_sine();
  polar_.resize(factors.size());
  for (const TurnedShares& group : by_turn(beam)) {
    const BeamShare& s = group.all;
    const PolarTable in_dish_frame(reach, threads, [&](double sine, double angle_rad) {
      const double one = s.one->voltage_at(sine, angle_rad, s.frequency_hz);
      return one * (s.other == s.one ? one : s.other->voltage_at(sine, angle_rad, s.frequency_hz));
    });
    PolarTable turned;
    for (const BeamShare* share : group.turned) turned.add_turned(in_dish_frame, share->turn_rad, share->weight);
    for (std::size_t f = 0; f < factors.size(); ++f) polar_[f].add_turned(turned, 0, factors[f](s.frequency_hz));
  }
  edge_.emplace(limit, reach / PolarTable::radii, reach, [&](double sine, double angle_rad) {
    double value[most_factors];
    for (std::size_t f = 0; f < polar_.size(); ++f) value[f] = polar_[f](sine, angle_rad);
    return level(value);
  });
}

void BeamTables::for_each_pixel(DirectionCosines axis, const ImageGeometry& geometry, int threads, const Visit& visit) const {
  if (!edge_) {
    for_each_within(radial_.front().reach(), axis, geometry, threads, [&](std::size_t pixel, double sine) {
      double value[most_factors];
      for (std::size_t f = 0; f < radial_.size(); ++f) value[f] = radial_[f](sine);
      visit(pixel, value);
    });
    return;
  }
  for_each_off_axis(edge_->farthest(), axis, geometry, threads, [&](std::size_t pixel, double sine, double angle_rad) {
    if (!edge_->holds(sine, angle_rad)) return;
    double value[most_factors];
    for (std::size_t f = 0; f < polar_.size(); ++f) value[f] = polar_[f](sine, angle_rad);
    visit(pixel, value);
  });
}

}  // namespace misfit::imager
