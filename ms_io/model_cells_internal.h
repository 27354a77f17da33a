#pragma once

#include <casacore/ms/MeasurementSets/MeasurementSet.h>
#include <casacore/tables/Tables/ArrayColumn.h>

#include <cstdint>
#include <vector>

#include "ms_io/model_writer.h"
#include "ms_io/row_columns_internal.h"

namespace misfit::ms_io {

/// A column of cells, correlations × channels.
class CellColumn {
 public:
  using Cells = casacore::Array<casacore::Complex>;

  CellColumn() = default;
  CellColumn(const casacore::MeasurementSet& set, const std::string& name);

  bool exists() const { return !column_.isNull(); }
  Cells operator()(casacore::rownr_t row) const { return column_(row); }
  void read(const Rows& rows, const casacore::Slicer& slice, Cells& cells) const { ms_io::read(column_, rows, slice, cells); }
  void write(const Rows& rows, const casacore::Slicer& slice, const Cells& cells);

  /// Throws AipsError when a cell has no shape, or another.
  void require_shape(const Rows& rows, const casacore::IPosition& shape) const;

 private:
  casacore::ArrayColumn<casacore::Complex> column_;
  bool fixed_shape_ = false;
};

/// Sums over rows of the fingerprints of their number and cells, from the first selected channel to the last one.
struct CellChecksum {
  std::uint64_t values = 0;
  std::uint64_t data = 0;  ///< of the data that the model was subtracted from; 0 where it was not

  CellChecksum& operator+=(const CellChecksum& other) {
    values += other.values;
    data += other.data;
    return *this;
  }
};

/// The new cells of a block, from the first selected channel to the last one.
struct BlockCells {
  CellColumn::Cells values;  ///< as they are stored, where channels between are not selected; after form() as they are to be
  CellColumn::Cells data;    ///< that the model is subtracted from; empty where it is not
  CellChecksum checksum;

  /// Puts `model` [row][selected channel] into the values, or the data without it. Needs no casacore table.
  void form(const Rows& rows, const Setup& setup, const StokesVisibilities& model);
};

/// The cells that a model goes into, and the cells it is subtracted from. All functions throw AipsError.
class ModelCells {
 public:
  ModelCells(const casacore::MeasurementSet& set, const ModelColumn& column);

  /// The data of a block, where they are needed; a function of its own, since messages tell errors in data from others.
  CellColumn::Cells data(const Rows& rows, const Setup& setup);
  /// The cells of a block before a model is formed.
  CellColumn::Cells values(const Rows& rows, const Setup& setup);
  void write(const Rows& rows, const Setup& setup, const CellColumn::Cells& values);

  /// The checksum of what the column holds now, and of the data.
  CellChecksum checksum(const Rows& rows, const Setup& setup);

 private:
  CellColumn model_, data_;
};

}  // namespace misfit::ms_io
