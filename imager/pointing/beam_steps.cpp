#include "imager/pointing/beam_steps.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

/// What all pairs of patterns see, at radii and angles; NaN from where one of them ends. Voltages themselves are less smooth:
/// roots of fitted powers.
ValuesAtFrequency sampled_pairs(const RowBeams& beams, double reach) {
  constexpr int radii = 96, angles = 8;
  std::set<const VoltagePattern*> different;
  for (const Pattern& pattern : beams.of_antennas())
    if (pattern) different.insert(pattern.get());
  return [different, reach](double hz) {
    std::vector<double> values;
    for (auto one = different.begin(); one != different.end(); ++one)
      for (auto other = one; other != different.end(); ++other) {
        const bool round = (*one)->is_round() && (*other)->is_round();
        const double ends = std::min((*one)->continuous_sine(hz), (*other)->continuous_sine(hz));
        for (int r = 1; r <= radii; ++r)
          for (int a = 0; a < (round ? 1 : angles); ++a) {
            const double sine = reach * r / radii, angle_rad = 2 * pi * a / angles;
            const auto seen = [&](const VoltagePattern& p) {
              return p.is_round() ? p.voltage(sine, hz) : p.voltage_at(sine, angle_rad, hz);
            };
            values.push_back(sine > ends ? std::nan("") : seen(**one) * seen(**other));
          }
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

}  // namespace

double turn_step(const RowBeams& beams, double reach, double frequency_hz, double tolerance) {
  const double steepest = steepest_turn(beams, reach, frequency_hz);
  return steepest > 0 ? 8 * tolerance / steepest : 0;
}

BeamSteps beam_steps(const RowBeams& beams, double reach, const std::vector<double>& frequency_hz, double tolerance) {
  BeamSteps steps{frequency_spans(frequency_hz, sampled_pairs(beams, reach), tolerance)};
  steps.turn_rad = turn_step(beams, reach, steps.spans.back().high_hz, tolerance);
  return steps;
}

}  // namespace misfit::imager
