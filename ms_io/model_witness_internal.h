#pragma once

#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ms_io/model_writer.h"
#include "ms_io/row_columns_internal.h"

namespace misfit::ms_io {

/// A cell that shows whether a column is as a run left it, by one channel: few bytes, which a kill does not cut in two.
struct Witness {
  std::uint64_t row = 0;
  std::uint64_t channel = 0;
  std::uint64_t before = 0;  ///< fingerprint of the correlations as the run found them
  std::uint64_t after = 0;   ///< of the correlations that it has written, or is about to write; until then as before
};

/// Up to 16, spread over the rows selected, of `column` as it is, or as it will be made. None where cells have no shape yet,
/// nor in tables that refer to the rows of others, which number them differently.
std::vector<Witness> choose_witnesses(const casacore::MeasurementSet& set, const ModelColumn& column,
                                      const SelectedRows& selected);

/// Notes in witnesses the values that are about to be written into `rows`: `values` correlations × channels × rows, from the
/// first selected channel on. False where none of the witnesses is among them.
bool foretell(std::vector<Witness>& witnesses, const Rows& rows, const Setup& setup,
              const casacore::Array<casacore::Complex>& values);

/// How many witnesses are neither as the run found them nor as it left them; 0 where `set` refers to other tables.
std::size_t changed(const std::vector<Witness>& witnesses, const casacore::Table& set, const std::string& column);

}  // namespace misfit::ms_io
