#pragma once

#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include "ms_io/model_writer.h"

namespace misfit::ms_io {

/// Gives the cells of an existing column that have no shape what those of a new column hold. Returns whether there were any:
/// `set` knows nothing of it, and is to be opened anew.
///
/// The index of a storage manager changes then, and casacore truncates the file or writes it piece by piece: killed meanwhile,
/// it leaves a table that no program opens. So this is done to a table beside, of links to the files of the first one and a
/// copy of that index, which takes the place of the first one as a whole. Throws std::runtime_error or AipsError.
bool give_missing_cells(const casacore::MeasurementSet& set, const ModelColumn& column);

}  // namespace misfit::ms_io
