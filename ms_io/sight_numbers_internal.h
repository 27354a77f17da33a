#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ms_io/beam_rows.h"
#include "ms_io/row_shares_internal.h"

namespace misfit::ms_io {

/// Rows of the main table from `first` on, up to the row where another pointing begins.
struct NumberedRows {
  std::uint64_t first = 0;
  int pointing = -1;
};

/// The numbers by which the sights of a set's rows name its antennas and pointings.
struct SightNumbers {
  int first_antenna = 0;  ///< of antenna 0; the others follow
  /// The pointings of selected rows where POINTING decides, ascending; else empty.
  std::vector<NumberedRows> of_rows = {};
  std::map<int, int> of_field = {};                    ///< [FIELD_ID] its pointing
  std::map<int, imager::SkyDirection> direction = {};  ///< [number of a pointing], in the frame of the image

  /// The pointing of a row of the main table; -1 where it is not known.
  int pointing(std::uint64_t row, int field) const;
};

/// Pointings have their FIELD_ID for their number, and antennas their id. Throws what field_pointings() does.
std::shared_ptr<const SightNumbers> numbers_by_id(const OpenSet& open_set, const imager::SkyDirection& centre);

/// Fills the numbers of each set with places in the table that it returns, whose pointings are those of fields or, with a
/// tolerance, of row_pointings(). Adds sentences for users to the remarks. Throws what field_pointings() and antenna_sorts()
/// do, or row_pointings().
SightTable number_sights(const OpenSets& sets, const imager::SkyDirection& centre, std::optional<double> tolerance_rad,
                         std::vector<std::string>& remarks);

}  // namespace misfit::ms_io
