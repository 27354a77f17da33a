#pragma once

#include <stdexcept>
#include <string>

#include "imager/beams/voltage_pattern.h"
#include "imager/data/antennas.h"

namespace misfit::imager {

/// The pattern that stands for antennas, and why it does.
struct BeamModel {
  Pattern pattern;
  std::string because;
  std::string doubt = {};  ///< a sentence where it may be wrong by more than a few percent at half power at any frequency

  /// Sentences on what may be wrong with it at a frequency; mostly empty.
  std::string doubt_at(double frequency_hz) const { return doubt.empty() ? pattern->doubt(frequency_hz) : doubt; }
};

/// Thrown for antennas whose beam is not that of a dish.
struct NoSimpleBeam : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The beam of antennas. For a known telescope it is the beam fitted to measurements, or the one that CASA takes; for others it
/// is the beam of a uniformly lit dish of their own diameter, with a doubt. Throws NoSimpleBeam, naming the telescope and the
/// reason, for stations and tiles of dipoles, cylinders and dishes that do not track, and for unknown antennas whose diameter
/// no dish has. Names are CASA's, whatever their capitals, blanks and dashes.
BeamModel beam_model(const AntennaSort& antennas);

/// The beam that a user asks for by name in place of the antennas' own: a telescope that is known, whatever the antennas are;
/// "airy", a uniformly lit dish of the antennas' own diameter; or "airy:D" and "airy:D:B", one of D metres with a dark middle
/// of B metres. Throws std::invalid_argument unless is_beam_name(), and NoSimpleBeam where the antennas have no diameter.
BeamModel named_beam(const std::string& name, const AntennaSort& antennas);

bool is_beam_name(const std::string& name);
/// Lists the names that named_beam() takes, for messages.
std::string expected_beam_names();

}  // namespace misfit::imager
