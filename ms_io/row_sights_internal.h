#pragma once

#include <memory>
#include <vector>

#include "imager/data/visibilities.h"
#include "ms_io/row_columns_internal.h"
#include "ms_io/sight_numbers_internal.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {

/// Reads the sights of a set's rows: their antennas, and the directions in which they observed.
class SightReader {
 public:
  /// Throws std::runtime_error where ANTENNA cannot be read.
  SightReader(const OpenSet& open_set, std::shared_ptr<const SightNumbers> numbers);
  ~SightReader();

  /// The sights, [row]. The zenith is 0 for antennas that do not turn with it, on other mounts than alt-azimuth. Throws
  /// casacore::AipsError where columns of these rows cannot be read.
  std::vector<imager::RowSight> sights(const Rows& rows);

 private:
  class Columns;
  std::unique_ptr<Columns> columns_;
};

/// Position angles of the zenith [row], from north through east, seen from where each row's field points in the frame of
/// `centre`. Dishes on alt-azimuth mounts turn by them; they are 0 for other mounts. The rows are in the order of blocks.
/// Throws std::runtime_error where ANTENNA, FIELD or the rows' times cannot be read.
std::vector<float> zenith_turns(const OpenSet& open_set, const imager::SkyDirection& centre);

}  // namespace misfit::ms_io
