#pragma once

#include <memory>
#include <string>

#include "ms_io/file_states_internal.h"
#include "ms_io/filled_data_internal.h"
#include "ms_io/selection_internal.h"
#include "ms_io/stokes.h"

namespace misfit::ms_io {

struct SightNumbers;

/// A MeasurementSet and the selection to read from it. It lives as long as a stream reads it.
struct OpenSet {
  std::string path;
  std::size_t place = 0;  ///< among the sets that are named
  std::string data_column;
  casacore::MeasurementSet set;
  SelectedRows selected;
  std::vector<StokesRecipe> recipes;   ///< [setup]
  FileStates files;                    ///< before it was opened
  std::shared_ptr<FilledData> filled;  ///< learned from all that this set and parts of it read; null without a data column
  std::shared_ptr<SightNumbers> sights = {};  ///< filled once all sets are open; null where blocks do not tell sights
};

/// Streams the blocks of `open_set`.
std::unique_ptr<imager::BlockStream> read_blocks(std::shared_ptr<const OpenSet> open_set);

}  // namespace misfit::ms_io
