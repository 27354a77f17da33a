#include "ms_io/table_access_internal.h"
#include "ms_io/value_flush_internal.h"

namespace misfit::ms_io {

ValueFlush::ValueFlush(const casacore::Table& set, const std::string& column) {
  const casacore::Block<casacore::String> names = set.getPartNames(true);
  for (std::size_t t = 0; t < names.nelements(); ++t) {
    const UnwrittenTable table{casacore::Table(names[t], set.lockOptions(), casacore::Table::Update)};  // that `set` has open
    try {
      tiles_.emplace_back(table, column, true);
    } catch (const casacore::AipsError&) {
      others_.push_back(table);
    }
  }
}

void ValueFlush::operator()() {
  for (casacore::ROTiledStManAccessor& tiles : tiles_) tiles.clearCaches();
  for (casacore::Table& table : others_) table.flush();
}

}  // namespace misfit::ms_io
