#pragma once

#include <cstddef>

namespace misfit::imager {

/// A table in somebody else's memory with any strides, as numpy's arrays have them.
template <typename T>
struct Strided {
  T* data = nullptr;  ///< of [0][0]; null: there is no table
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::ptrdiff_t row_step = 0;  ///< from a row to the next, in values
  std::ptrdiff_t column_step = 1;

  explicit operator bool() const { return data != nullptr; }
  T& at(std::size_t row, std::size_t column) const {
    return data[static_cast<std::ptrdiff_t>(row) * row_step + static_cast<std::ptrdiff_t>(column) * column_step];
  }
  /// True if values follow upon another, row after row.
  bool dense() const {
    const bool rows_follow = rows <= 1 || row_step == static_cast<std::ptrdiff_t>(columns);
    return rows_follow && (columns <= 1 || column_step == 1);
  }
};

}  // namespace misfit::imager
