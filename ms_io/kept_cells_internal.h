#pragma once

#include <casacore/tables/Tables/Table.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ms_io/model_cells_internal.h"
#include "ms_io/model_journal_internal.h"

namespace misfit::ms_io {

/// The cells of a block before data − model take their place in the column from which the data are read: a run that is killed
/// meanwhile leaves some of the cells changed, and nobody could tell which. A file `misfit_kept_<COLUMN>` in the set's folder
/// holds the block that is being written.
class KeptCells {
 public:
  /// Of the column that `journal` tells of.
  KeptCells(const casacore::Table& set, const std::string& column);

  /// Keeps `cells` of `rows`, after which `journal` says which rows come before. Throws std::runtime_error that names the file.
  void keep(const ModelJournal& journal, std::size_t setup, const Rows& rows, const CellColumn::Cells& cells) const;
  /// Puts the kept cells back where the run of `journal` was cut short while it wrote them.
  void put_back(const ModelJournal& journal, const std::vector<Setup>& setups, ModelCells& column) const;
  void forget() const;

 private:
  std::string path_;
};

}  // namespace misfit::ms_io
