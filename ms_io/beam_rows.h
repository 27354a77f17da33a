#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "imager/antennas.h"
#include "imager/geometry.h"

namespace misfit::ms_io {

/// Where the antennas of a field pointed.
struct FieldPointing {
  std::string field;  ///< "3 (M51)"
  imager::SkyDirection direction;
};

/// The sorts of antennas of a row, as places in a list.
struct SortPair {
  std::uint8_t one = 0;
  std::uint8_t other = 0;
};

/// What rows were observed with, and in which direction.
struct BeamRows {
  std::vector<imager::AntennaSort> sorts;  ///< of antennas in rows of two antennas
  std::vector<SortPair> pairs;             ///< [row], in the order in which blocks hold them; empty where there is one sort
  /// FIELD's REFERENCE_DIR, of all fields with selected rows, in the frame of the image. It stays where it is when visibilities
  /// are shifted to another phase centre, which moves PHASE_DIR. The table POINTING is not looked at, as in tclean by default.
  std::vector<FieldPointing> pointings;
  double beam_offset_rad = 0;  ///< the largest by which FEED's BEAM_OFFSET says that a beam points elsewhere, of feeds in use
};

}  // namespace misfit::ms_io
