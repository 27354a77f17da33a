#pragma once

#include <string>

#include "imager/beams/telescopes.h"

namespace misfit::tools {

/// The beams of a run's antennas: their telescope's, or one that --beam gives for all.
class DishBeams {
 public:
  /// The antennas' own.
  DishBeams() = default;
  /// Of --beam: empty, as above; a name as imager::named_beam() takes; "voltage:FILE", or FILE, of a power. Throws what
  /// read_beam_file() throws.
  explicit DishBeams(const std::string& beam);

  /// Throws imager::NoSimpleBeam.
  imager::BeamModel of(const imager::AntennaSort& antennas) const;

 private:
  std::string beam_;
  imager::Pattern of_file_;  ///< null without one
};

/// Throws std::invalid_argument that names the option unless `beam` is empty, a name, or a file.
void check_beam(const std::string& beam);

}  // namespace misfit::tools
