#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <filesystem>
#include <vector>

#include "ms_io/missing_cells_internal.h"
#include "ms_io/model_column_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

namespace fs = std::filesystem;
using Column = casacore::ArrayColumn<casacore::Complex>;

struct MissingCell {
  casacore::rownr_t row;
  casacore::IPosition shape;  ///< that it is to have
};

/// The cells without a shape, except in rows of a DATA_DESC_ID that does not exist, which nothing selects.
std::vector<MissingCell> missing_cells(const casacore::MeasurementSet& set, const std::string& name) {
  const Column column(set, name);
  std::vector<MissingCell> missing;
  if (column.columnDesc().isFixedShape()) return missing;
  const std::vector<casacore::IPosition> shapes = cell_shapes(set, set.tableName());
  const std::vector<int> setup = casacore::ScalarColumn<int>(set, "DATA_DESC_ID").getColumn().tovector();
  for (std::size_t row = 0; row < setup.size(); ++row) {
    const auto s = static_cast<std::size_t>(setup[row]);
    if (s < shapes.size() && !column.isDefined(row)) missing.push_back({row, shapes[s]});
  }
  return missing;
}

/// Fills `folder` with links to the files of `table`, and a copy of the file `index`. Links to a lock file would share its
/// locks, which closing them ends.
void link_files(const fs::path& table, const fs::path& folder, const std::string& index) {
  fs::create_directory(folder);
  for (const fs::directory_entry& entry : fs::directory_iterator(table)) {
    const fs::path name = entry.path().filename();
    if (!entry.is_regular_file() || name == "table.lock") continue;
    if (name == index) {
      fs::copy_file(entry, folder / name);
    } else {
      fs::create_symlink(".." / name, folder / name);
    }
  }
}

/// Moves files that are no links from `folder` to `table`: files that only the new index names, and the index last.
void move_files(const fs::path& folder, const fs::path& table, const std::string& index) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path name = entry.path().filename();
    if (!entry.is_symlink() && name != index) fs::rename(entry, table / name);
  }
  fs::rename(folder / index, table / index);
}

bool give_missing_cells_of_one(const casacore::MeasurementSet& set, const ModelColumn& column) {
  const fs::path table = std::string(set.tableName()), folder = table / ("misfit_beside_" + column.name);
  fs::remove_all(folder);  // that a killed run left
  const std::vector<MissingCell> missing = missing_cells(set, column.name);
  if (missing.empty()) return false;
  const std::string index = "table.f" + std::to_string(storage_of(set, column.name).asuInt("SEQNR"));
  link_files(table, folder, index);
  {
    UnwrittenTable beside(casacore::Table(folder.string(), casacore::TableLock::NoLocking, casacore::Table::Update));
    Column cells(beside, column.name), data;
    if (!column.subtracted_from.empty()) data.attach(beside, column.subtracted_from);
    for (const auto& [row, shape] : missing) {
      const bool with_data = !data.isNull() && data.isDefined(row);
      cells.put(row, with_data ? data(row) : casacore::Array<casacore::Complex>(shape, casacore::Complex(0)));
    }
    beside.flush();
  }
  move_files(folder, table, index);
  fs::remove_all(folder);
  return true;
}

}  // namespace

bool give_missing_cells(const casacore::MeasurementSet& set, const ModelColumn& column) {
  bool any = false;
  const casacore::Block<casacore::String> names = set.getPartNames(true);
  for (std::size_t t = 0; t < names.nelements(); ++t) {
    const casacore::MeasurementSet part(names[t], set.lockOptions(), casacore::Table::Update);
    any = give_missing_cells_of_one(part, column) || any;
  }
  return any;
}

}  // namespace misfit::ms_io
