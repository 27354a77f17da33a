#pragma once

#include <casacore/casa/Arrays/Array.h>
#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/RefRows.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <string>

#include "ms_io/selection_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {

/// The rows of one access to the table.
class Rows {
 public:
  explicit Rows(const std::vector<Run>& runs);

  std::uint64_t count() const { return count_; }
  bool contiguous() const { return contiguous_; }
  casacore::Slicer range() const;                              ///< only when contiguous
  const casacore::RefRows& listed() const { return listed_; }  ///< always
  std::uint64_t index_of(casacore::rownr_t row) const;         ///< count() where it is not among them
  casacore::rownr_t operator[](std::uint64_t i) const { return contiguous_ ? first_ + i : numbers_.data()[i]; }

 private:
  bool contiguous_;
  casacore::rownr_t first_;
  casacore::Vector<casacore::rownr_t> numbers_;  ///< unless contiguous
  std::uint64_t count_;
  casacore::RefRows listed_;
};

/// The shapes of the cells of an array column, as far as known without a look at each.
struct CellShapes {
  bool one = false;  ///< all cells that are defined have one shape
  bool all = false;  ///< all cells have that shape
};

CellShapes known_shapes(const casacore::Table& table, const std::string& column);

/// Keeps the tiles that a column holds in memory within 64 MiB. Without this, slices of channels leave all tiles that they
/// touched in memory.
void limit_tile_cache(const casacore::Table& table, const std::string& column);

/// `runs` cut into pieces of at most `rows` rows.
std::vector<Rows> pieces(const std::vector<Run>& runs, std::uint64_t rows);

/// All correlations of the channels from the first selected to the last one.
casacore::Slicer channel_slice(const Setup& setup, std::size_t correlations);

template <typename T>
void read(const casacore::ScalarColumn<T>& column, const Rows& rows, casacore::Vector<T>& values) {
  if (rows.contiguous()) {
    column.getColumnRange(rows.range(), values, true);
  } else {
    column.getColumnCells(rows.listed(), values, true);
  }
}

template <typename T>
void read(const casacore::ArrayColumn<T>& column, const Rows& rows, casacore::Array<T>& values) {
  if (rows.contiguous()) {
    column.getColumnRange(rows.range(), values, true);
  } else {
    column.getColumnCells(rows.listed(), values, true);
  }
}

template <typename T>
void read(const casacore::ArrayColumn<T>& column, const Rows& rows, const casacore::Slicer& slice, casacore::Array<T>& values) {
  if (rows.contiguous()) {
    column.getColumnRange(rows.range(), slice, values, true);
  } else {
    column.getColumnCells(rows.listed(), slice, values, true);
  }
}

}  // namespace misfit::ms_io
