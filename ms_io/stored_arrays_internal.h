#pragma once

#include <cstdint>
#include <string>

#include "ms_io/table_file_internal.h"

namespace misfit::ms_io {

/// The file of arrays that a storage manager of casacore keeps apart from other columns, each with its shape before it.
class StoredArrays {
 public:
  /// Reads its head. Throws as StoredBytes() does.
  StoredArrays(const std::string& path, ByteOrder order);

  /// Throws std::runtime_error that names the file where it cannot hold a cell of the shape that the column states for all.
  void check_column(const StoredColumn& column) const;
  /// Throws std::runtime_error that names the file where the array at a place, with its texts if it has any, is not within the
  /// file, or not of the column's shape. Place 0 stands for no array. Files of more than 1 GiB are left to casacore: to look at
  /// each array is to read all of them.
  void check(std::int64_t place, const StoredColumn& column);

 private:
  StoredBytes bytes_;
  ByteOrder order_;
  bool counts_references_ = false;
};

}  // namespace misfit::ms_io
