#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "imager/data/antennas.h"
#include "imager/data/geometry.h"

namespace misfit::ms_io {

/// The sorts of antennas of a row, as places in a list.
struct SortPair {
  std::uint8_t one = 0;
  std::uint8_t other = 0;
};

/// How many rows have these sorts.
struct SortRows {
  SortPair pair;
  std::uint64_t rows = 0;
};

/// Where the antennas of a field pointed: its REFERENCE_DIR, at one of three times where that moves, and as it stands in the
/// image where the image moves along. It stays where it is when visibilities are shifted to another phase centre, which moves
/// PHASE_DIR. The table POINTING is looked at where Selection::pointing_tolerance_rad is given, and then only for a SightTable.
struct FieldPointing {
  std::string field;                ///< "3 (M51)", or "3 (M51) at 2026-01-02T03:04:05"
  imager::SkyDirection direction;   ///< in the frame of the image
  int id = 0;                       ///< FIELD_ID
  std::string name = {};            ///< "M51"
  std::string set = {};             ///< path of the set whose field it is
  double from_centre_rad = 0;       ///< from the phase centre of the image
  double smallest_dish_m = 0;       ///< diameter of the set's smallest antenna; 0 where none is known
  std::vector<SortRows> rows = {};  ///< its rows of two antennas; in BeamRows alone
};

/// The lists in which the numbers of rows' sights, see imager::RowSight, are places.
struct SightTable {
  std::vector<imager::AntennaSort> antennas;  ///< set by set, as ANTENNA lists them
  std::vector<FieldPointing> pointings;       ///< set by set; their rows are not counted
};

/// The offset of a feed's beam from its dish's axis: the mean of its receptors' BEAM_OFFSETs in FEED, on the sky, along axes of
/// the antenna's frame, which mounts turn.
struct FeedOffset {
  int feed = 0;  ///< FEED_ID
  double x_rad = 0;
  double y_rad = 0;
  int antenna = -1;      ///< the first with this offset; -1: all have it
  std::string set = {};  ///< path

  double rad() const { return std::hypot(x_rad, y_rad); }
};

/// The antennas and feeds of rows, and the directions in which they observed.
struct BeamRows {
  std::vector<imager::AntennaSort> sorts;  ///< of the antennas in rows of two antennas
  std::vector<SortPair> pairs;             ///< [row], in the order in which blocks hold them; empty where there is one sort
  std::vector<FieldPointing> pointings;    ///< of all fields with selected rows, see field_pointings()
  std::vector<FeedOffset> feeds;           ///< of feeds in use, each different offset once for a set

  /// The largest offset of a feed.
  double beam_offset_rad() const {
    double largest = 0;
    for (const FeedOffset& feed : feeds) largest = std::max(largest, feed.rad());
    return largest;
  }
};

}  // namespace misfit::ms_io
