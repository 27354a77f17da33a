#pragma once

#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include <string>
#include <vector>

#include "ms_io/model_writer.h"

namespace misfit::ms_io {

/// Throws std::runtime_error unless `column` is one that write_model may write in `set`, or create.
void require_writable_column(const casacore::MeasurementSet& set, const std::string& path, const ModelColumn& column);

/// Throws std::runtime_error that says that the column is there already, and may not be.
[[noreturn]] void throw_exists(const std::string& path, const std::string& column);

/// TYPE, NAME, COLUMNS, SEQNR and SPEC of the storage manager of `column`.
casacore::Record storage_of(const casacore::Table& set, const casacore::String& column);

/// The shape of a cell of each DATA_DESC_ID: correlations × channels.
std::vector<casacore::IPosition> cell_shapes(const casacore::MeasurementSet& set, const std::string& path);

/// Adds `column`, complex, shaped and tiled as DATA is (one tile shape for each shape of cell, when these vary), full of zeros
/// or of the data that something will be subtracted from. Afterwards the set on disk has the column, or, when this fails, has
/// not. Throws std::runtime_error that names path and column.
void create_model_column(casacore::MeasurementSet& set, const std::string& path, const ModelColumn& column);

}  // namespace misfit::ms_io
