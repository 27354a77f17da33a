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

using Cells = casacore::Array<casacore::Complex>;

/// `column` with its names spelt out.
ModelColumn spelt_out(const ModelColumn& column) {
  return {column_name(column.name), column_name(column.subtracted_from), column.may_exist};
}

void require_writable_column(const casacore::MeasurementSet& set, const std::string& path, const ModelColumn& column) {
  const std::string& data = column.subtracted_from;
  if (column.name.empty() || column.name == "DATA") {
    throw std::runtime_error("a model cannot be written to column '" + column.name + "' of " + path +
                             "; expected a column other than DATA, such as " +
                             (data.empty() ? "MODEL_DATA" : "CORRECTED_DATA"));
  }
  if (column.name == data) {
    throw std::runtime_error("data − model cannot be written to column '" + column.name + "' of " + path +
                             ", from which the data are read: a run cut short could not be mended; expected another column");
  }
  if (!data.empty()) require_visibility_column(set, path, data);
  if (!set.tableDesc().isColumn(column.name)) return;
  if (!column.may_exist) {
    throw std::runtime_error(path + " has a column " + column.name +
                             " already, which may hold calibrated data; expected another --column, or this one by name");
  }
  require_visibility_column(set, path, column.name);
}

/// A column of cells, correlations × channels.
class CellColumn {
 public:
  CellColumn() = default;
  CellColumn(const casacore::MeasurementSet& set, const std::string& name)
      : column_(set, name), fixed_shape_(column_.columnDesc().isFixedShape()) {}

  bool exists() const { return !column_.isNull(); }
  void read(const Rows& rows, const casacore::Slicer& slice, Cells& cells) const { ms_io::read(column_, rows, slice, cells); }
  void write(const Rows& rows, const casacore::Slicer& slice, const Cells& cells) {
    if (rows.contiguous()) {
      column_.putColumnRange(rows.range(), slice, cells);
    } else {
      column_.putColumnCells(rows.listed(), slice, cells);
    }
  }

  /// Gives cells that have no shape yet what `blank(row)` returns. Throws AipsError when one has another shape than `shape`.
  template <typename Blank>
  void require_shape(const Rows& rows, const casacore::IPosition& shape, const Blank& blank) {
    if (fixed_shape_ && column_.shapeColumn().isEqual(shape)) return;
    for (const casacore::rownr_t row : rows.numbers()) {
      if (!column_.isDefined(row)) column_.put(row, blank(row));
      if (!column_.shape(row).isEqual(shape)) {
        throw casacore::AipsError("the cell of row " + std::to_string(row) + " has shape " + column_.shape(row).toString() +
                                  "; expected " + shape.toString());
      }
    }
  }
  Cells operator()(casacore::rownr_t row) const { return column_(row); }

 private:
  casacore::ArrayColumn<casacore::Complex> column_;
  bool fixed_shape_ = false;
};

class Writer {
 public:
  Writer(casacore::MeasurementSet& set, const ModelColumn& column) : uvw_column_(set, "UVW"), model_column_(set, column.name) {
    if (!column.subtracted_from.empty()) data_column_ = CellColumn(set, column.subtracted_from);
  }

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

  /// The data of a block from its first selected channel to the last one, where they are needed.
  Cells data(const Rows& rows, const Setup& setup) {
    Cells cells;
    if (!data_column_.exists()) return cells;
    data_column_.require_shape(rows, stored_shape(setup), [](casacore::rownr_t row) -> Cells {
      throw casacore::AipsError("row " + std::to_string(row) + " has no data");
    });
    data_column_.read(rows, channel_slice(setup, setup.correlation_types.size()), cells);
    return cells;
  }

  /// Stores `stokes_i` [row][selected channel], or `data` without it; channels that are not selected keep what they hold.
  void write(const Rows& rows, const Setup& setup, const std::vector<std::complex<double>>& stokes_i, const Cells& data) {
    const std::size_t correlations = setup.correlation_types.size(), span = setup.channel_span();
    const casacore::IPosition shape = stored_shape(setup);
    model_column_.require_shape(rows, shape, [&](casacore::rownr_t row) {
      return data_column_.exists() ? data_column_(row) : Cells(shape, casacore::Complex(0));
    });
    const casacore::Slicer slice = channel_slice(setup, correlations);
    Cells cells(casacore::IPosition(3, shape(0), static_cast<ssize_t>(span), static_cast<ssize_t>(rows.count())));
    if (setup.channels.size() > 1) model_column_.read(rows, slice, cells);
    const std::complex<double>* in = stokes_i.data();
    for (std::size_t r = 0; r < rows.count(); ++r) {
      for (const Run& run : setup.channels) {
        std::size_t at = (r * span + run.first - setup.first_channel()) * correlations;
        for (std::uint64_t c = 0; c < run.count; ++c, ++in, at += correlations) {
          form_sample(setup, *in, data.empty() ? nullptr : data.data() + at, cells.data() + at);
        }
      }
    }
    model_column_.write(rows, slice, cells);
  }

 private:
  static casacore::IPosition stored_shape(const Setup& setup) {
    return casacore::IPosition(2, static_cast<ssize_t>(setup.correlation_types.size()),
                               static_cast<ssize_t>(setup.stored_channels));
  }

  /// All correlations of one sample: of the model, or of the data without it where there are `data`.
  static void form_sample(const Setup& setup, std::complex<double> stokes_i, const casacore::Complex* data,
                          casacore::Complex* out) {
    for (const int type : setup.correlation_types) {
      const bool receives = receives_stokes_i(type);
      if (data == nullptr) {
        *out++ = receives ? casacore::Complex(stokes_i) : casacore::Complex(0);
      } else {
        *out++ = receives ? casacore::Complex(std::complex<double>(*data) - stokes_i) : *data;
        ++data;
      }
    }
  }

  casacore::ArrayColumn<double> uvw_column_;
  CellColumn model_column_, data_column_;
};

/// At `where` of the set itself, of a model about the phase centre that `shift` leads to.
std::vector<std::complex<double>> predicted(const Predict& predict, const imager::PhaseShift& shift,
                                            const imager::SampleCoordinates& where, const std::vector<bool>& unknown) {
  imager::SampleCoordinates shifted = where;
  shift.rotate(shifted.uvw_m);
  std::vector<std::complex<double>> stokes_i = predict(shifted);
  if (stokes_i.size() != where.samples()) {
    throw std::invalid_argument("prediction returned " + std::to_string(stokes_i.size()) + " visibilities; expected " +
                                std::to_string(where.samples()));
  }
  shift.undo(where, stokes_i);
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
    stokes_i = std::async(std::launch::async, [this, &predict] { return predicted(predict, setup->shift, where, unknown); });
  }
};

}  // namespace

void require_writable(const std::string& path, const ModelColumn& column) {
  require_writable_column(open_measurement_set(path, Access::update), path, spelt_out(column));
}

ModelWriteReport write_model(const std::string& path, const Selection& selection, const ModelColumn& column,
                             const Predict& predict, const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                             std::uint64_t block_samples) {
  const ModelColumn written = spelt_out(column);
  casacore::MeasurementSet set = open_measurement_set(path, Access::update);
  require_writable_column(set, path, written);
  const SelectedRows selected = select_rows(set, path, selection, block_samples);
  describe(set, path, selected);  // throws unless there is one phase centre
  if (!set.tableDesc().isColumn(written.name)) create_model_column(set, path, written);
  const std::string doing = "cannot write " + written.name + " of " + path;
  Writer writer = translated(doing, [&] { return Writer(set, written); });
  ModelWriteReport report;
  std::unique_ptr<PredictedBlock> before;  // is written while the next one is predicted
  const auto write = [&](const PredictedBlock& block, const std::vector<std::complex<double>>& stokes_i) {
    const Cells data = translated("cannot read " + written.subtracted_from + " of " + path,
                                  [&] { return writer.data(block.rows, *block.setup); });
    translated(doing, [&] { writer.write(block.rows, *block.setup, stokes_i, data); });
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
