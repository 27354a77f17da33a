#pragma once

#include <string>
#include <vector>

#include "imager/beams/telescopes.h"

namespace misfit::tools {

/// The beams of a run's antennas: their telescope's, or one that --beam gives for all.
class DishBeams {
 public:
  /// The antennas' own.
  DishBeams() = default;
  /// The beams of --beam: the antennas' own where it is empty; a name as imager::named_beam() takes; "voltage:FILE", or FILE,
  /// of a power. Throws what read_beam_file() throws.
  explicit DishBeams(const std::string& beam);

  /// Throws imager::NoSimpleBeam.
  imager::BeamModel of(const imager::AntennaSort& antennas) const;

 private:
  std::string beam_;
  imager::Pattern of_file_;  ///< null without one
};

/// The antennas whose patterns are made, and how.
struct WantedPatterns {
  const std::vector<imager::AntennaSort>& sorts;  ///< of the antennas that rows of two antennas have
  const DishBeams& beams;
  double frequency_hz = 0;  ///< at which doubts are told
};

/// The patterns, [antenna]; null for an antenna without a simple beam that no row of two antennas has. Adds doubts about them,
/// a sentence each, once. Throws imager::NoSimpleBeam.
std::vector<imager::Pattern> patterns_of(const std::vector<imager::AntennaSort>& antennas, const WantedPatterns& wanted,
                                         std::vector<std::string>& doubts);

/// The narrowest of the beams between half-power points, about.
double narrowest_rad(const std::vector<imager::Pattern>& patterns, double frequency_hz);

/// Throws std::invalid_argument that names the option unless `beam` is empty, a name, or a file.
void check_beam(const std::string& beam);

}  // namespace misfit::tools
