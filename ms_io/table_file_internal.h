#pragma once

#include <casacore/casa/Utilities/DataType.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ms_io/stored_bytes_internal.h"

namespace misfit::ms_io {

/// Bits that a value of one of casacore's DataType takes in a file; of a text, those of the length before it.
std::uint64_t bits_of(std::uint64_t data_type);

struct StoredColumn {
  std::string name;
  casacore::DataType type = casacore::TpOther;  ///< of a value
  bool is_array = false;
  bool in_place = false;            ///< among the other columns of its row, not in a file of arrays
  bool has_shape = false;           ///< one for all cells
  std::vector<std::int64_t> shape;  ///< that, where it has one
  std::uint64_t longest_text = 0;   ///< 0: any
  std::uint64_t manager = 0;        ///< its number
};

/// A storage manager, and what the table keeps for it.
struct StorageManager {
  std::string type;
  std::uint64_t number = 0;  ///< in the names of its files
  std::string kept;
};

/// What `table.dat` tells of a table.
struct TableFile {
  std::uint64_t rows = 0;
  ByteOrder order = ByteOrder::big;  ///< of what storage managers write
  std::vector<StoredColumn> columns;
  std::vector<StorageManager> managers;
  std::vector<std::string> tables;  ///< paths of those that it refers to, or that lie in its keywords
};

/// Reads the file of the table at `path` as casacore does, without taking memory for what it says it holds but does not. Throws
/// std::runtime_error that names the file where it says so, where records lie in each other beyond any use, or where it has a
/// kind of column that casacore does not know, over which it would end the program; Malformed where casacore says what is
/// wrong.
TableFile read_table_file(const std::string& path);

}  // namespace misfit::ms_io
