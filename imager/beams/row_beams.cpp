#include "imager/beams/row_beams.h"

#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

namespace misfit::imager {

double PairBeam::power(DirectionCosines at, double frequency_hz) const {
  const double sine = frame.sine(at);
  if (!(sine <= 1)) return 0;
  if (is_round()) {
    const double seen = one->voltage(sine, frequency_hz);
    return seen * (other == one ? seen : other->voltage(sine, frequency_hz));
  }
  const double angle_rad = frame.angle_rad(at) - zenith_rad, seen = one->voltage_at(sine, angle_rad, frequency_hz);
  return seen * (other == one ? seen : other->voltage_at(sine, angle_rad, frequency_hz));
}

std::vector<Source> seen_by(const PairBeam& beam, std::vector<Source> sources, double frequency_hz) {
  for (Source& source : sources) source.flux_jy *= beam.power(source.position, frequency_hz);
  return sources;
}

const Pattern& RowBeams::of_antenna(int antenna) const {
  const auto place = static_cast<std::size_t>(antenna);
  if (antenna < 0 || place >= of_antenna_.size() || !of_antenna_[place])
    throw std::runtime_error("rows of antenna " + std::to_string(antenna) +
                             ", of which no primary beam is known; expected rows of antennas with one");
  return of_antenna_[place];
}

std::vector<RowBeams::Group> RowBeams::groups(const SampleCoordinates& at, double turn_rad) const {
  if (at.sights.size() != at.rows())
    throw std::invalid_argument(std::to_string(at.sights.size()) + " sights of " + std::to_string(at.rows()) +
                                " rows; expected one for each");
  using Key = std::tuple<const VoltagePattern*, const VoltagePattern*, int, double>;
  std::map<Key, std::size_t> place;
  std::vector<Group> groups;
  for (std::size_t row = 0; row < at.sights.size(); ++row) {
    const RowSight& sight = at.sights[row];
    const Pattern& one = of_antenna(sight.antenna_one);
    const Pattern& other = of_antenna(sight.antenna_other);
    const AxisFrame& frame = of_field_.at(static_cast<std::size_t>(sight.field));
    double zenith_rad = one->is_round() && other->is_round() ? 0 : double{sight.zenith_rad};
    if (turn_rad > 0) zenith_rad = turn_rad * std::round(zenith_rad / turn_rad);
    const auto [group, is_new] = place.insert({{one.get(), other.get(), sight.field, zenith_rad}, groups.size()});
    if (is_new) groups.push_back({{one, other, frame, zenith_rad}, sight.field, {}});
    groups[group->second].rows.push_back(row);
  }
  return groups;
}

SampleCoordinates rows_of(const SampleCoordinates& at, const std::vector<std::size_t>& rows) {
  if (rows.size() == at.rows()) return at;  // they ascend
  std::vector<double> uvw_m;
  uvw_m.reserve(3 * rows.size());
  for (const std::size_t row : rows) uvw_m.insert(uvw_m.end(), at.uvw_m.data() + 3 * row, at.uvw_m.data() + 3 * row + 3);
  return {std::move(uvw_m), at.frequency_hz};
}

}  // namespace misfit::imager
