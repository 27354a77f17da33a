#include "ms_io/fingerprint.h"
#include "ms_io/model_cells_internal.h"
#include "ms_io/stokes_response_internal.h"

namespace misfit::ms_io {
namespace {

using Cells = CellColumn::Cells;

casacore::IPosition stored_shape(const Setup& setup) {
  return casacore::IPosition(2, static_cast<ssize_t>(setup.correlation_types.size()),
                             static_cast<ssize_t>(setup.stored_channels));
}

std::uint64_t checksum_of(const Rows& rows, const Cells& cells) {
  const std::size_t row_values = rows.count() == 0 ? 0 : cells.nelements() / rows.count();
  std::uint64_t sum = 0;
  const casacore::Complex* row = cells.data();
  for (std::uint64_t r = 0; r < rows.count(); ++r) {
    sum += Fingerprint().add(rows[r]).add(row, row_values * sizeof(casacore::Complex)).value();
    row += row_values;
  }
  return sum;
}

}  // namespace

CellColumn::CellColumn(const casacore::MeasurementSet& set, const std::string& name)
    : column_(set, name), fixed_shape_(column_.columnDesc().isFixedShape()) {}

void CellColumn::write(const Rows& rows, const casacore::Slicer& slice, const Cells& cells) {
  if (rows.contiguous()) {
    column_.putColumnRange(rows.range(), slice, cells);
  } else {
    column_.putColumnCells(rows.listed(), slice, cells);
  }
}

void CellColumn::require_shape(const Rows& rows, const casacore::IPosition& shape) const {
  if (fixed_shape_ && column_.shapeColumn().isEqual(shape)) return;
  for (std::uint64_t r = 0; r < rows.count(); ++r) {
    const casacore::rownr_t row = rows[r];
    if (!column_.isDefined(row)) throw casacore::AipsError("row " + std::to_string(row) + " has no data");
    if (column_.shape(row).isEqual(shape)) continue;
    throw casacore::AipsError("the cell of row " + std::to_string(row) + " has shape " + column_.shape(row).toString() +
                              "; expected " + shape.toString());
  }
}

ModelCells::ModelCells(const casacore::MeasurementSet& set, const ModelColumn& column) : model_(set, column.name) {
  if (!column.subtracted_from.empty()) data_ = CellColumn(set, column.subtracted_from);
}

Cells ModelCells::data(const Rows& rows, const Setup& setup) {
  Cells cells;
  if (!data_.exists()) return cells;
  data_.require_shape(rows, stored_shape(setup));
  data_.read(rows, channel_slice(setup, setup.correlation_types.size()), cells);
  return cells;
}

Cells ModelCells::values(const Rows& rows, const Setup& setup) {
  const casacore::IPosition shape = stored_shape(setup);
  model_.require_shape(rows, shape);
  Cells cells;
  if (setup.channels.size() > 1) {
    model_.read(rows, channel_slice(setup, setup.correlation_types.size()), cells);
  } else {
    cells.resize(
        casacore::IPosition(3, shape(0), static_cast<ssize_t>(setup.channel_span()), static_cast<ssize_t>(rows.count())));
  }
  return cells;
}

void ModelCells::write(const Rows& rows, const Setup& setup, const Cells& values) {
  model_.write(rows, channel_slice(setup, setup.correlation_types.size()), values);
}

void BlockCells::form(const Rows& rows, const Setup& setup, const StokesVisibilities& model) {
  const std::size_t correlations = setup.correlation_types.size(), span = setup.channel_span();
  std::size_t from = 0;
  for (std::size_t r = 0; r < rows.count(); ++r) {
    for (const Run& run : setup.channels) {
      const std::size_t at = (r * span + run.first - setup.first_channel()) * correlations;
      for (std::size_t k = 0; k < correlations; ++k) {
        form_correlation(stokes_response(setup.correlation_types[k]), model, from,
                         {data.empty() ? nullptr : data.data() + at + k, values.data() + at + k, correlations, run.count});
      }
      from += run.count;
    }
  }
  checksum = {checksum_of(rows, values), data.empty() ? 0 : checksum_of(rows, data)};
}

CellChecksum ModelCells::checksum(const Rows& rows, const Setup& setup) {
  model_.require_shape(rows, stored_shape(setup));
  Cells cells;
  model_.read(rows, channel_slice(setup, setup.correlation_types.size()), cells);
  return {checksum_of(rows, cells), data_.exists() ? checksum_of(rows, data(rows, setup)) : 0};
}

}  // namespace misfit::ms_io
