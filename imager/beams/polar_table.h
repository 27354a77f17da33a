#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace misfit::imager {

/// A function of the direction beside an axis, by sin θ and position angle.
using PolarFunction = std::function<double(double sine, double angle_rad)>;

/// A PolarFunction from its axis to a radius, tabulated at radii and angles, with polynomials through four points each way
/// between them: right to 1e-5 for beams that have no finer detail than their main lobe.
class PolarTable {
 public:
  static constexpr int radii = 256, angles = 180;

  PolarTable() = default;
  PolarTable(double reach, int threads, const PolarFunction& function);

  /// The value at sin θ up to the reach.
  double operator()(double sine, double angle_rad) const;
  double reach() const { return reach_; }

  /// Adds another of the same reach, turned by an angle from north to east, times `by`. Turns lie between steps of the angle.
  void add_turned(const PolarTable& other, double turn_rad, double by);

 private:
  double at(int radius, int angle) const;

  double reach_ = 0;
  std::vector<double> value_;  ///< [radius][angle], one radius beyond the reach, and one more
};

/// Where a lobe about an axis ends, by position angle: where a function first falls to a level.
class LobeEdge {
 public:
  /// Looks for the edge in steps of sin θ up to `farthest`, where the lobe ends at the latest.
  LobeEdge(double level, double step, double farthest, const PolarFunction& function);

  double farthest() const;
  bool holds(double sine, double angle_rad) const;

 private:
  std::vector<double> sine_;  ///< [angle]
};

}  // namespace misfit::imager
