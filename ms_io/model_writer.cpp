#include "ms_io/model_writer.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <memory>
#include <stdexcept>

#include "ms_io/metadata_internal.h"
#include "ms_io/model_column_internal.h"
#include "ms_io/row_columns_internal.h"
#include "ms_io/stokes.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

void require_writable_column(const casacore::MeasurementSet& set, const std::string& path, const std::string& column) {
  if (column.empty() || column == "DATA") {
    throw std::runtime_error("a model cannot be written to column '" + column + "' of " + path +
                             "; expected a column other than DATA, such as MODEL_DATA");
  }
  if (set.tableDesc().isColumn(column)) require_visibility_column(set, path, column);
}

class Writer {
 public:
  Writer(casacore::MeasurementSet& set, const std::string& column)
      : uvw_column_(set, "UVW"), model_column_(set, column), fixed_shape_(model_column_.columnDesc().isFixedShape()) {}

  /// Where the block lies; rows with a non-finite UVW are put at 0 and marked.
  imager::SampleCoordinates coordinates(const Rows& rows, const Setup& setup, std::vector<bool>& unknown) const {
    casacore::Array<double> uvw;
    read(uvw_column_, rows, uvw);
    imager::SampleCoordinates where{uvw.tovector(), setup.frequency_hz};
    unknown.assign(rows.count(), false);
    for (std::size_t r = 0; r < rows.count(); ++r) {
      double* const row = where.uvw_m.data() + 3 * r;
      if (std::isfinite(row[0]) && std::isfinite(row[1]) && std::isfinite(row[2])) continue;
      unknown[r] = true;
      row[0] = row[1] = row[2] = 0;
    }
    return where;
  }

  /// Stores `stokes_i` [row][selected channel]; channels that are not selected keep what they hold.
  void write(const Rows& rows, const Setup& setup, const std::vector<std::complex<double>>& stokes_i) {
    const std::size_t correlations = setup.correlation_types.size(), span = setup.channel_span();
    require_shape(rows,
                  casacore::IPosition(2, static_cast<ssize_t>(correlations), static_cast<ssize_t>(setup.stored_channels)));
    const casacore::Slicer slice = channel_slice(setup, correlations);
    casacore::Array<casacore::Complex> cells(casacore::IPosition(
        3, static_cast<ssize_t>(correlations), static_cast<ssize_t>(span), static_cast<ssize_t>(rows.count())));
    if (setup.channels.size() > 1) read(model_column_, rows, slice, cells);
    const std::complex<double>* in = stokes_i.data();
    for (std::size_t r = 0; r < rows.count(); ++r) {
      for (const Run& run : setup.channels) {
        casacore::Complex* out = cells.data() + (r * span + run.first - setup.first_channel()) * correlations;
        for (std::uint64_t c = 0; c < run.count; ++c, ++in) {
          for (const int type : setup.correlation_types) {
            *out++ = receives_stokes_i(type) ? casacore::Complex(*in) : casacore::Complex(0);
          }
        }
      }
    }
    if (rows.contiguous()) {
      model_column_.putColumnRange(rows.range(), slice, cells);
    } else {
      model_column_.putColumnCells(rows.listed(), slice, cells);
    }
  }

 private:
  /// Gives cells that have no shape yet `shape` and zeros. Throws AipsError when one has another shape.
  void require_shape(const Rows& rows, const casacore::IPosition& shape) {
    if (fixed_shape_ && model_column_.shapeColumn().isEqual(shape)) return;
    for (const casacore::rownr_t row : rows.numbers()) {
      if (!model_column_.isDefined(row)) {
        model_column_.put(row, casacore::Array<casacore::Complex>(shape, casacore::Complex(0)));
      } else if (!model_column_.shape(row).isEqual(shape)) {
        throw casacore::AipsError("the cell of row " + std::to_string(row) + " has shape " +
                                  model_column_.shape(row).toString() + "; expected " + shape.toString());
      }
    }
  }

  casacore::ArrayColumn<double> uvw_column_;
  casacore::ArrayColumn<casacore::Complex> model_column_;
  bool fixed_shape_;
};

std::vector<std::complex<double>> predicted(const Predict& predict, const imager::SampleCoordinates& where,
                                            const std::vector<bool>& unknown) {
  std::vector<std::complex<double>> stokes_i = predict(where);
  if (stokes_i.size() != where.samples()) {
    throw std::invalid_argument("prediction returned " + std::to_string(stokes_i.size()) + " visibilities; expected " +
                                std::to_string(where.samples()));
  }
  for (std::size_t r = 0; r < unknown.size(); ++r) {
    if (!unknown[r]) continue;
    const auto row = stokes_i.begin() + static_cast<std::ptrdiff_t>(r * where.channels());
    std::fill_n(row, where.channels(), 0.0);
  }
  return stokes_i;
}

/// A block on its way from its coordinates to the column.
struct PredictedBlock {
  const Setup* setup;
  Rows rows;
  imager::SampleCoordinates where;
  std::vector<bool> unknown;
  std::future<std::vector<std::complex<double>>> stokes_i;

  PredictedBlock(const BlockRows& block, const std::vector<Setup>& setups) : setup(&setups[block.setup]), rows(block.runs) {}

  /// Another thread predicts; casacore is for one thread alone.
  void begin(const Predict& predict) {
    stokes_i = std::async(std::launch::async, [this, &predict] { return predicted(predict, where, unknown); });
  }
};

}  // namespace

void require_writable(const std::string& path) {
  open_measurement_set(path, Access::update);
}

ModelWriteReport write_model(const std::string& path, const Selection& selection, const std::string& column,
                             const Predict& predict, const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                             std::uint64_t block_samples) {
  const std::string name = column_name(column);
  casacore::MeasurementSet set = open_measurement_set(path, Access::update);
  require_writable_column(set, path, name);
  const SelectedRows selected = select_rows(set, path, selection, block_samples);
  describe(set, path, selected);  // throws unless there is one phase centre
  if (!set.tableDesc().isColumn(name)) create_model_column(set, path, name);
  const std::string doing = "cannot write " + name + " of " + path;
  Writer writer = translated(doing, [&] { return Writer(set, name); });
  ModelWriteReport report;
  std::unique_ptr<PredictedBlock> before;  // is written while the next one is predicted
  const auto write = [&](const PredictedBlock& block, const std::vector<std::complex<double>>& stokes_i) {
    translated(doing, [&] { writer.write(block.rows, *block.setup, stokes_i); });
    report.rows += block.rows.count();
    report.samples += block.where.samples();
    for (const bool row_is_unknown : block.unknown) report.nonfinite_uvw_rows += row_is_unknown;
    if (progress) progress(report.samples, selected.samples);
  };
  for (const BlockRows& rows : selected.blocks) {
    auto block = std::make_unique<PredictedBlock>(rows, selected.setups);
    block->where = translated("cannot read UVW of " + path,
                              [&] { return writer.coordinates(block->rows, *block->setup, block->unknown); });
    std::vector<std::complex<double>> stokes_i;
    if (before) stokes_i = before->stokes_i.get();  // predictions have all threads, one after the other
    block->begin(predict);
    if (before) write(*before, stokes_i);
    before = std::move(block);
  }
  if (before) write(*before, before->stokes_i.get());
  translated(doing, [&] { set.flush(); });
  return report;
}

}  // namespace misfit::ms_io
