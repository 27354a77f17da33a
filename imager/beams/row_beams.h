#pragma once

#include <cstddef>
#include <vector>

#include "imager/beams/axis_frame.h"
#include "imager/beams/voltage_pattern.h"
#include "imager/data/source.h"
#include "imager/data/visibilities.h"

namespace misfit::imager {

/// How a pair of dishes that point alike sees the sky.
struct PairBeam {
  Pattern one;
  Pattern other;
  AxisFrame frame;        ///< about where they point
  double zenith_rad = 0;  ///< where the zenith is, from north through east; of no matter where both patterns are round

  bool is_round() const { return one->is_round() && other->is_round(); }
  /// Vₒₙₑ Vₒₜₕₑᵣ, signed, of a direction that is seen from the phase centre; 0 where it is 90° or more from the axis, or beyond
  /// the horizon.
  double power(DirectionCosines at, double frequency_hz) const;
};

/// The sources as they appear to the pair at a frequency; Gaussians are scaled as at their middle.
std::vector<Source> seen_by(const PairBeam& beam, std::vector<Source> sources, double frequency_hz);

/// Finds how rows see the sky, from the antennas and fields in their sights.
class RowBeams {
 public:
  /// Rows that see alike.
  struct Group {
    PairBeam beam;
    int field = 0;  ///< of these rows
    std::vector<std::size_t> rows;
  };

  /// Patterns [antenna], null for antennas that no row has, and frames about where antennas pointed [field], by the numbers in
  /// rows' sights.
  RowBeams(std::vector<Pattern> of_antenna, std::vector<AxisFrame> of_field)
      : of_antenna_(std::move(of_antenna)), of_field_(std::move(of_field)) {}

  /// The groups in the order of their first rows. Where patterns are not round, rows see alike if their zeniths differ by less
  /// than `turn_rad`; 0: if their zeniths are the same. Throws std::invalid_argument where coordinates come without the sights
  /// of their rows, std::runtime_error that names an antenna without a pattern, std::out_of_range for fields that it was not
  /// given.
  std::vector<Group> groups(const SampleCoordinates& at, double turn_rad = 0) const;

  const std::vector<Pattern>& of_antennas() const { return of_antenna_; }
  const std::vector<AxisFrame>& of_fields() const { return of_field_; }

 private:
  const Pattern& of_antenna(int antenna) const;

  std::vector<Pattern> of_antenna_;
  std::vector<AxisFrame> of_field_;
};

/// The rows of these coordinates with these numbers.
SampleCoordinates rows_of(const SampleCoordinates& at, const std::vector<std::size_t>& rows);

}  // namespace misfit::imager
