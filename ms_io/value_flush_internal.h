#pragma once

#include <casacore/tables/DataMan/TiledStManAccessor.h>
#include <casacore/tables/Tables/Table.h>

#include <string>
#include <vector>

namespace misfit::ms_io {

/// Hands the values of a column to the system, so that they outlive this process.
///
/// Flushing or closing a table, casacore truncates the header of a tiled column and writes it anew, though nothing in it has
/// changed: killed between the two, it leaves a table that no program opens. So the tables of a tiled column are not flushed,
/// their tiles are, and as long as all cells have a shape no more needs to be.
class ValueFlush {
 public:
  /// The rows of `set` may be those of several tables. Whatever else was changed in them is to be flushed before: they are
  /// closed as they lie on disk then.
  ValueFlush(const casacore::Table& set, const std::string& column);
  /// Throws AipsError.
  void operator()();

 private:
  std::vector<casacore::ROTiledStManAccessor> tiles_;
  std::vector<casacore::Table> others_;  ///< where the column is stored otherwise: casacore changes those files in place
};

}  // namespace misfit::ms_io
