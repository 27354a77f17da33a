#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ms_io/stored_records_internal.h"

namespace misfit::ms_io {

struct StoredColumn {
  std::string name;
  casacore::DataType type = casacore::TpOther;  ///< of a value
  bool is_array = false;
  bool in_place = false;            ///< among the other columns of its row, not in a file of arrays
  bool has_shape = false;           ///< one for all cells
  std::vector<std::int64_t> shape;  ///< the shape, where it has one
  std::uint64_t longest_text = 0;   ///< 0: any
  std::uint64_t manager = 0;        ///< its number
};

/// A storage manager, and the bytes that the table keeps for it.
struct StorageManager {
  std::string type;
  std::uint64_t number = 0;  ///< in the names of its files
  std::string kept;
};

/// The content of a table's `table.dat`.
struct TableFile {
  std::uint64_t rows = 0;
  ByteOrder order = ByteOrder::big;  ///< of the storage managers' files
  std::vector<StoredColumn> columns;
  std::vector<StorageManager> managers;
  std::vector<std::string> references;  ///< paths of the tables whose rows are its own
  std::vector<std::string> subtables;   ///< paths of the tables in its keywords
};

/// Reads the file of the table at `path` as casacore does, without taking memory for content that the file states but does not
/// hold. Throws std::runtime_error that names the file where there is such content, where records are nested beyond any use, or
/// where a column is of a kind that casacore does not know, over which it would end the program; Malformed where casacore says
/// what is wrong.
TableFile read_table_file(const std::string& path);

/// The columns that one of its storage managers stores, in its order.
std::vector<StoredColumn> columns_of(const TableFile& table, const StorageManager& manager);

/// The file of a storage manager of the table at `path`.
std::string file_of(const std::string& path, const StorageManager& manager);

}  // namespace misfit::ms_io
