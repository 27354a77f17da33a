#pragma once

#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include "ms_io/model_writer.h"

namespace misfit::ms_io {

/// Fills the cells of an existing column that have no shape as the cells of a new column. Returns whether there were any: `set`
/// does not notice it, and is to be opened anew.
///
/// This changes the index of a storage manager, a file that casacore truncates and writes piece by piece: a process killed
/// meanwhile leaves a table that no program opens. So the cells are filled in a second table beside the first one, of links to
/// its files and a copy of that index, and the new index then replaces the old one as a whole. Throws std::runtime_error or
/// AipsError.
bool give_missing_cells(const casacore::MeasurementSet& set, const ModelColumn& column);

}  // namespace misfit::ms_io
