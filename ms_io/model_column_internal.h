#pragma once

#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include <string>

namespace misfit::ms_io {

/// Adds `column`, complex and full of zeros, shaped and tiled as DATA is (one tile shape for each shape of cell, when these
/// vary). Throws std::runtime_error that names path and column.
void create_model_column(casacore::MeasurementSet& set, const std::string& path, const std::string& column);

}  // namespace misfit::ms_io
