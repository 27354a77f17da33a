#pragma once

#include <casacore/tables/Tables/Table.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ms_io/model_cells_internal.h"
#include "ms_io/model_witness_internal.h"

namespace misfit::ms_io {

/// How far a column has been written. During a run a file `misfit_unfinished_<COLUMN>` in the folder of each table that holds
/// the rows says so; casacore knows nothing of it. It is true wherever the run is killed: the rows are handed to the system
/// first, and the file is replaced as a whole afterwards.
struct ModelJournal {
  std::string column;
  std::string command;                   ///< that writes it, as people are told
  std::string identity;                  ///< of model, options, selection and columns; empty: not known
  std::uint64_t rows = 0;                ///< to be written
  std::uint64_t written = 0;             ///< rows
  std::uint64_t nonfinite_uvw_rows = 0;  ///< of the rows written
  CellChecksum checksum;                 ///< of the rows written
  std::vector<Witness> witnesses;        ///< cells that show whether the column is as it was left, without reading all of it
  std::map<std::size_t, std::uint64_t> done_below;  ///< by setup: its selected rows below this one are written
};

/// `misfit_<KIND>_<COLUMN>` in the folder of every table that holds rows of `set`: `set` itself, or the tables that it refers
/// to.
std::vector<std::string> files_beside(const casacore::Table& set, const std::string& kind, const std::string& column);
/// Replaces a file as a whole. Throws std::runtime_error that names the file and `meaning`.
void replace_file(const std::string& path, const std::string& contents, const std::string& meaning);
void remove_file(const std::string& path);

/// The journal of `column`; none where no run is under way, or was cut short. A file that cannot be understood is a journal
/// without facts.
std::optional<ModelJournal> read_journal(const casacore::Table& set, const std::string& column);
/// Throws std::runtime_error that names the file.
void write_journal(const casacore::Table& set, const ModelJournal& journal);
void remove_journal(const casacore::Table& set, const std::string& column);

/// True if another program has written all of the column since, so that the journal is void.
bool outlived(const casacore::Table& set, const ModelJournal& journal);

/// "MODEL_DATA of `path` is incomplete: 12 of 30 rows were written before by …".
std::string incompleteness(const std::string& path, const ModelJournal& journal);

}  // namespace misfit::ms_io
