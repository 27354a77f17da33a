#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "imager/beams/cubic_weights.h"
#include "imager/data/geometry.h"

namespace misfit::imager {

/// A function of the angle θ ≤ 90° from an axis, given sin θ.
using RadialFunction = std::function<double(double sine)>;

/// sin θ of where the function, which is above `level` on the axis, first falls to it, looked for in steps of `step`; 1 where
/// it does not.
double first_sine_at(double level, double step, const RadialFunction& function);

/// A function from its axis to a radius, at points close enough that a cubic through four of them is right to 1e-10 in the main
/// lobe of a primary beam.
class RadialTable {
 public:
  RadialTable(double reach, int threads, const RadialFunction& function);

  /// The points that count at a radius, and their weights: the same in all tables of one reach.
  struct Place {
    int cell;
    std::array<double, 4> weight;  ///< of the points before the cell, at both its ends, and behind it
  };

  /// The place of a direction whose sin θ is the reach at most.
  Place place(double sine) const {
    const double at = sine / step();
    const int cell = std::min(static_cast<int>(at), points - 1);
    return {cell, cubic_weights(at - cell)};
  }
  double operator()(const Place& place) const {
    const double* const v = value_.data() + place.cell;
    return place.weight[0] * v[0] + place.weight[1] * v[1] + place.weight[2] * v[2] + place.weight[3] * v[3];
  }
  double operator()(double sine) const { return (*this)(place(sine)); }
  double reach() const { return reach_; }

 private:
  friend class RadialTables;
  static constexpr int points = 1024;
  double step() const { return reach_ / points; }

  double reach_;
  std::vector<double> value_;  ///< [point + 1]
};

/// Several such functions, whose values lie together.
class RadialTables {
 public:
  /// Writes the values of all functions.
  using Functions = std::function<void(double sine, double* values)>;

  /// Tabulates `detail` times as many points as a RadialTable, for functions with `detail` times as much detail as a primary
  /// beam.
  RadialTables(double reach, int threads, std::size_t count, const Functions& functions, double detail = 1);

  std::size_t count() const { return count_; }
  /// Writes the values of `some` functions from `first` on in a direction whose sin θ is the reach at most.
  void write(double sine, std::size_t first, std::size_t some, double* values) const {
    const double at = sine / step_;
    const int cell = std::min(static_cast<int>(at), points_ - 1);
    const std::array<double, 4> weight = cubic_weights(at - cell);
    const double* const v = value_.data() + static_cast<std::size_t>(cell) * count_ + first;
    for (std::size_t k = 0; k < some; ++k)
      values[k] = weight[0] * v[k] + weight[1] * v[count_ + k] + weight[2] * v[2 * count_ + k] + weight[3] * v[3 * count_ + k];
  }

 private:
  std::size_t count_;
  int points_;
  double step_;
  std::vector<double> value_;  ///< [point + 1][function]
};

/// Calls visit(pixel, sin θ, position angle) for the pixels that for_each_within() visits. The angle is that of the direction
/// about the axis, from the north there through the east.
void for_each_off_axis(double reach, DirectionCosines axis, const ImageGeometry& geometry, int threads,
                       const std::function<void(std::size_t pixel, double sine, double angle_rad)>& visit);

/// Calls visit(pixel, sin θ) for all pixels of an image whose true angle θ from `axis`, a direction seen from the phase centre,
/// has a sine of `reach` at most and is below 90°, except pixels beyond the horizon.
void for_each_within(double reach, DirectionCosines axis, const ImageGeometry& geometry, int threads,
                     const std::function<void(std::size_t pixel, double sine)>& visit);

}  // namespace misfit::imager
