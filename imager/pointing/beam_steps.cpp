#include "imager/pointing/beam_steps.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

/// Voltages of all patterns, and their squares, at radii and angles; NaN from where they end.
ValuesAtFrequency sampled_patterns(const RowBeams& beams, double reach) {
  constexpr int radii = 96, angles = 8;
  std::set<const VoltagePattern*> different;
  for (const Pattern& pattern : beams.of_antennas())
    if (pattern) different.insert(pattern.get());
  return [different, reach](double hz) {
    std::vector<double> values;
    for (const VoltagePattern* pattern : different)
      for (int r = 1; r <= radii; ++r)
        for (int a = 0; a < (pattern->is_round() ? 1 : angles); ++a) {
          const double sine = reach * r / radii, angle_rad = 2 * pi * a / angles;
          if (sine > pattern->continuous_sine(hz)) {
            values.insert(values.end(), 2, std::nan(""));
            continue;
          }
          const double seen = pattern->is_round() ? pattern->voltage(sine, hz) : pattern->voltage_at(sine, angle_rad, hz);
          values.push_back(seen);
          values.push_back(seen * seen);
        }
    return values;
  };
}

/// By how much the power of any pattern changes with its position angle, at most, per radian.
double steepest_turn(const RowBeams& beams, double reach, double frequency_hz) {
  constexpr int radii = 48, angles = 90;
  constexpr double step_rad = 2 * pi / angles;
  double steepest = 0;
  for (const Pattern& pattern : beams.of_antennas()) {
    if (!pattern || pattern->is_round()) continue;
    for (int r = 1; r <= radii; ++r)
      for (int a = 0; a < angles; ++a) {
        const double one = pattern->voltage_at(reach * r / radii, a * step_rad, frequency_hz);
        const double next = pattern->voltage_at(reach * r / radii, (a + 1) * step_rad, frequency_hz);
        steepest = std::max(steepest, std::abs(next * next - one * one) / step_rad);
      }
  }
  return steepest;
}

/// Steps of turns that are wrong by four times the tolerance at most.
double turn_step(const RowBeams& beams, double reach, double frequency_hz, double tolerance) {
  const double steepest = steepest_turn(beams, reach, frequency_hz);
  return steepest > 0 ? 8 * tolerance / steepest : 0;
}

}  // namespace

BeamSteps beam_steps(const RowBeams& beams, double reach, const std::vector<double>& frequency_hz, double tolerance,
                     std::size_t most_nodes) {
  BeamSteps steps{frequency_spans(frequency_hz, sampled_patterns(beams, reach), tolerance, most_nodes)};
  steps.turn_rad = turn_step(beams, reach, steps.spans.back().high_hz, tolerance);
  return steps;
}

}  // namespace misfit::imager
