#pragma once

#include <map>

#include "ms_io/beam_rows.h"
#include "ms_io/row_shares_internal.h"

namespace misfit::ms_io {

/// The numbers by which the sights of a set's rows name its antennas and pointings.
struct SightNumbers {
  int first_antenna = 0;                               ///< of antenna 0; the others follow
  std::map<int, int> of_field = {};                    ///< [FIELD_ID] its pointing
  std::map<int, imager::SkyDirection> direction = {};  ///< [number of a pointing], in the frame of the image

  /// -1 where it is not known.
  int pointing(int field) const {
    const auto found = of_field.find(field);
    return found == of_field.end() ? -1 : found->second;
  }
};

/// Pointings have the FIELD_ID for their number, and antennas theirs. Throws what field_pointings() does.
std::shared_ptr<const SightNumbers> numbers_by_id(const OpenSet& open_set, const imager::SkyDirection& centre);

/// Fills the numbers of each set with places in the table. Throws what field_pointings() and antenna_sorts() do.
SightTable number_sights(const OpenSets& sets, const imager::SkyDirection& centre);

}  // namespace misfit::ms_io
