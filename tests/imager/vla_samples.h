#pragma once

#include <cmath>

#include "imager/data/visibilities.h"
#include "imager/direct/direct_transform.h"
#include "imager/numerics/constants.h"

namespace misfit::imager::testing {

/// The 351 baselines of 27 antennas on three arms at distances ∝ (i/9)^1.716, seen at equally spaced hour angles within ±3 h of
/// transit (one: at transit) at declination 40° from latitude 34°. 4 GHz, w left out, weight 1, visibilities 0.
inline VisibilityBlock vla_samples(int hour_angles, double arm_m = 21000) {
  constexpr double degree = pi / 180;
  constexpr double latitude = 34 * degree, declination = 40 * degree;
  std::vector<double> east, north;
  for (const double azimuth : {-5 * degree, 115 * degree, 236 * degree})
    for (int i = 1; i <= 9; ++i) {
      const double r = arm_m * std::pow(i / 9.0, 1.716);
      east.push_back(r * std::sin(azimuth));
      north.push_back(r * std::cos(azimuth));
    }
  VisibilityBlock block;
  block.frequency_hz = {4e9};
  for (int k = 0; k < hour_angles; ++k) {
    const double hour_angle = hour_angles == 1 ? 0 : (6.0 * k / (hour_angles - 1) - 3) * 15 * degree;
    const double s = std::sin(hour_angle), c = std::cos(hour_angle);
    for (std::size_t a = 0; a < east.size(); ++a)
      for (std::size_t b = a + 1; b < east.size(); ++b) {
        const double x = -std::sin(latitude) * (north[b] - north[a]);  // to the meridian on the equator
        const double y = east[b] - east[a];
        const double z = std::cos(latitude) * (north[b] - north[a]);
        const double v = std::sin(declination) * (s * y - c * x) + std::cos(declination) * z;
        for (const double coordinate : {s * x + c * y, v, 0.0}) block.uvw_m.edit().push_back(coordinate);
      }
  }
  block.weight.assign(block.samples(), 1);
  block.visibility.resize(block.samples());
  return block;
}

/// Gives the block the visibilities of point sources.
inline void observe(const std::vector<Source>& sources, VisibilityBlock& block) {
  const auto exact = predict_sources(sources, block, 2);
  block.visibility.assign(exact.begin(), exact.end());
}

}  // namespace misfit::imager::testing
