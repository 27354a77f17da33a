#pragma once

#include <casacore/tables/DataMan/TiledStManAccessor.h>
#include <casacore/tables/Tables/Table.h>

#include <string>
#include <vector>

namespace misfit::ms_io {

/// Hands the values of a column to the system, so that they outlive this process.
///
/// When a table is flushed or closed, casacore truncates the header of a tiled column and writes it anew, though nothing in it
/// has changed: a process killed between the two leaves a table that no program opens. So only the tiles of a tiled column are
/// flushed, not its tables: that is enough as long as all cells have a shape.
class ValueFlush {
 public:
  /// The rows of `set` may be those of several tables. Other changes in these tables must be flushed before: they are closed as
  /// they then lie on disk.
  ValueFlush(const casacore::Table& set, const std::string& column);
  /// Throws AipsError.
  void operator()();

 private:
  std::vector<casacore::ROTiledStManAccessor> tiles_;
  std::vector<casacore::Table> others_;  ///< where the column is stored otherwise: casacore changes those files in place
};

}  // namespace misfit::ms_io
