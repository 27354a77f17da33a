#include "tools/drawing/sky_marks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace misfit::tools {

SkyFrame sky_frame(const imager::ImageGeometry& geometry) {
  const ScaledUnit unit = angle_unit(std::max(geometry.width, geometry.height) * geometry.cell_rad);
  const double half = geometry.cell_rad / 2;
  return {.unit = unit,
          .east = (geometry.l(0) + half) / unit.size,
          .west = (geometry.l(geometry.width - 1) - half) / unit.size,
          .south = (geometry.m(0) - half) / unit.size,
          .north = (geometry.m(geometry.height - 1) + half) / unit.size};
}

SkyOffset beam_reach(const imager::Beam& beam) {
  const double sine = std::sin(beam.position_angle_rad), cosine = std::cos(beam.position_angle_rad);
  return {std::hypot(beam.major_rad * sine, beam.minor_rad * cosine) / 2,
          std::hypot(beam.major_rad * cosine, beam.minor_rad * sine) / 2};
}

std::vector<SkyOffset> beam_ellipse(const imager::Beam& beam) {
  constexpr int steps = 72;
  const double sine = std::sin(beam.position_angle_rad), cosine = std::cos(beam.position_angle_rad);
  std::vector<SkyOffset> outline;
  for (int step = 0; step <= steps; ++step) {
    const double angle = 2 * std::numbers::pi * step / steps;
    const double along = beam.major_rad / 2 * std::cos(angle);
    const double across = beam.minor_rad / 2 * std::sin(angle);
    outline.push_back({along * sine - across * cosine, along * cosine + across * sine});
  }
  return outline;
}

ScaleBar scale_bar(double longest_rad) {
  constexpr double degree = std::numbers::pi / 180;
  const double longest = longest_rad * (1 + 1e-9);
  const auto bar = [](double length, const ScaledUnit& unit) {
    return ScaleBar{length * unit.size, significant(length, 1) + " " + unit.name};
  };
  for (const ScaledUnit& unit : {ScaledUnit{degree / 60, "arcmin"}, ScaledUnit{degree / 3600, "arcsec"}}) {
    if (longest < unit.size || longest >= degree) continue;
    for (const double length : {30, 20, 10, 5, 2, 1})
      if (length * unit.size <= longest) return bar(length, unit);
  }
  const ScaledUnit unit = longest >= degree ? ScaledUnit{degree, "deg"} : ScaledUnit{degree / 3.6e6, "mas"};
  const double decade = std::pow(10.0, std::floor(std::log10(longest / unit.size)));
  return bar((longest >= 5 * decade * unit.size ? 5 : longest >= 2 * decade * unit.size ? 2 : 1) * decade, unit);
}

}  // namespace misfit::tools
