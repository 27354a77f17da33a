#pragma once

#include <casacore/tables/Tables/Table.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ms_io/model_cells_internal.h"
#include "ms_io/model_journal_internal.h"

namespace misfit::ms_io {

/// Keeps the cells of a block while data − model replaces them in the column of the data: a run that is killed then leaves some
/// of the cells changed, and nobody could tell which. A file `misfit_kept_<COLUMN>` in the set's folder holds the block that is
/// being written.
class KeptCells {
 public:
  /// For the column called `column`.
  KeptCells(const casacore::Table& set, const std::string& column);

  /// Keeps `cells` of `rows`, with the rows of `journal` that were written before them. Throws std::runtime_error that names
  /// the file.
  void keep(const ModelJournal& journal, std::size_t setup, const Rows& rows, const CellColumn::Cells& cells) const;
  /// Puts the kept cells back where the run of `journal` was cut short while it wrote them.
  void put_back(const ModelJournal& journal, const std::vector<Setup>& setups, ModelCells& column) const;
  void forget() const;

 private:
  std::string path_;
};

}  // namespace misfit::ms_io
