#include <casacore/tables/DataMan/DataManager.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "ms_io/column_reader_internal.h"

namespace misfit::ms_io {

ColumnReader::ColumnReader(std::shared_ptr<const OpenSet> source) : source_(std::move(source)) {
  translated("cannot read the columns of " + source_->path, [&] {
    const casacore::Table& table = source_->set;
    antenna1_.attach(table, "ANTENNA1");
    antenna2_.attach(table, "ANTENNA2");
    several_observations_ = source_->set.observation().nrow() > 1;
    if (several_observations_) observation_.attach(table, "OBSERVATION_ID");
    time_.attach(table, "TIME");
    needs_time_ = !source_->selected.spectral_frame.empty() || source_->selected.shift_moves();
    flag_row_.attach(table, "FLAG_ROW");
    flag_row_is_dear_ = table.findDataManager("FLAG_ROW", true)->dataManagerType() == "IncrementalStMan";
    attach(uvw_, "UVW");
    attach(data_, source_->data_column);
    attach(flag_, "FLAG");
    attach(weight_, "WEIGHT");
    has_spectrum_ = table.tableDesc().isColumn("WEIGHT_SPECTRUM");
    if (has_spectrum_) attach(spectrum_, "WEIGHT_SPECTRUM");
  });
}

template <typename T>
void ColumnReader::attach(Cells<T>& cells, const std::string& name) const {
  cells.name = name;
  cells.column.attach(source_->set, name);
  cells.shapes = known_shapes(source_->set, name);
  limit_tile_cache(source_->set, name);
}

template <typename Action>
void ColumnReader::reading(const std::string& column, const Action& action) const {
  translated("cannot read " + column + " of " + source_->path, action);
}

void ColumnReader::read_rows(const Rows& rows, const Setup& setup, StoredRows& stored) {
  reading("ANTENNA1", [&] { read(antenna1_, rows, stored.antenna1); });
  reading("ANTENNA2", [&] { read(antenna2_, rows, stored.antenna2); });
  read_narrow(uvw_, rows, casacore::IPosition(1, 3), stored.uvw);
  read_channels(data_, rows, setup, stored.data);
  read_channels(flag_, rows, setup, stored.flag);
  reading("FLAG_ROW", [&] { read_flag_rows(rows, stored); });
  read_weights(rows, setup, stored);
  if (needs_time_) reading("TIME", [&] { read(time_, rows, stored.time_s); });
  if (!source_->selected.spectral_frame.empty()) find_frame_ratios(rows, setup, stored);
}

namespace {

/// The frame ratio of a row. A flagged row may have a time at which the place of a moving field is not known.
double frame_ratio_of(FrameRatio& ratio, const StoredRows& stored, std::size_t row) {
  try {
    return ratio.at(stored.time_s[row]);
  } catch (const std::runtime_error&) {
    if (!stored.flag_row[row]) throw;
    return 1;
  }
}

}  // namespace

FrameRatio& ColumnReader::frame_ratio(const Setup& setup, int observation) {
  std::unique_ptr<FrameRatio>& ratio = ratio_[{setup.spectral_frame, setup.field, observation}];
  if (!ratio) ratio = std::make_unique<FrameRatio>(source_->set, source_->path, source_->selected, setup, observation);
  return *ratio;
}

void ColumnReader::find_frame_ratios(const Rows& rows, const Setup& setup, StoredRows& stored) {
  casacore::Vector<int> observation(rows.count(), 0);
  if (several_observations_) reading("OBSERVATION_ID", [&] { read(observation_, rows, observation); });
  stored.frame_ratio.resize(rows.count());
  translated("cannot convert frequencies of " + source_->path + " to " + source_->selected.spectral_frame, [&] {
    FrameRatio* ratio = nullptr;
    for (std::size_t r = 0; r < rows.count(); ++r) {
      if (r == 0 || observation[r] != observation[r - 1]) ratio = &frame_ratio(setup, observation[r]);
      stored.frame_ratio[r] = frame_ratio_of(*ratio, stored, r);
    }
  });
}

/// An IncrementalStMan searches for every row whose value differs from the row before; rows whose samples are all flagged need
/// no FLAG_ROW.
void ColumnReader::read_flag_rows(const Rows& rows, StoredRows& stored) const {
  if (!flag_row_is_dear_) return read(flag_row_, rows, stored.flag_row);
  stored.flag_row.resize(rows.count());
  const std::size_t cell = stored.flag.size() / rows.count();
  const bool* const flag = stored.flag.data();
  bool* const flag_row = stored.flag_row.data();
  for (std::uint64_t r = 0; r < rows.count(); ++r)
    flag_row[r] = std::memchr(flag + r * cell, 0, cell) == nullptr || flag_row_(rows[r]);
}

template <typename T>
void ColumnReader::require_cell(const Cells<T>& cells, casacore::rownr_t row, const casacore::IPosition& shape) const {
  const bool defined = cells.column.isDefined(row);
  if (defined && cells.column.shape(row).isEqual(shape)) return;
  throw std::runtime_error(
      "cannot read " + cells.name + " of " + source_->path + ": the cell of row " + std::to_string(row) +
      (defined ? " has the shape " + cells.column.shape(row).toString() : " is empty") + "; expected " + shape.toString() +
      ", as DATA_DESC_ID says" +
      (!defined && cells.name == "CORRECTED_DATA" ? "; where it was never filled, --datacolumn data takes DATA" : ""));
}

/// Looks at the first of `rows`, or at all of them.
template <typename T>
void ColumnReader::require_shape(const Cells<T>& cells, const Rows& rows, const casacore::IPosition& shape, bool all) const {
  require_cell(cells, rows[0], shape);
  if (!all || cells.shapes.all) return;
  for (std::uint64_t r = 1; r < rows.count(); ++r)
    if (!cells.shapes.one || !cells.column.isDefined(rows[r])) require_cell(cells, rows[r], shape);
}

/// casacore 3.5 throws where a cell is undefined or has another shape, with two exceptions: reading a whole column it takes one
/// shape for granted, and ends the program at an undefined cell; and reading slices it takes cells of any shape that holds
/// them.
template <typename T, typename Action>
void ColumnReader::reading_cells(const Cells<T>& cells, const Rows& rows, const casacore::IPosition& shape, bool sliced,
                                 const Action& action) const {
  reading(cells.name, [&] {
    require_shape(cells, rows, shape, sliced || (rows.contiguous() && rows.count() == cells.column.nrow()));
    try {
      action();
    } catch (const std::exception&) {
      require_shape(cells, rows, shape, true);
      throw;
    }
  });
}

template <typename T>
void ColumnReader::read_cells(const Cells<T>& cells, const Rows& rows, const casacore::IPosition& shape,
                              casacore::Array<T>& values) const {
  reading_cells(cells, rows, shape, false, [&] { read(cells.column, rows, values); });
}

/// Reads a column of a few values a row as a whole: casacore is then many times as fast as with ranges of rows.
template <typename T>
void ColumnReader::read_narrow(Cells<T>& cells, const Rows& rows, const casacore::IPosition& shape,
                               casacore::Array<T>& values) const {
  constexpr casacore::rownr_t most_rows = 1 << 19;
  const casacore::rownr_t all_rows = cells.column.nrow();
  if (!cells.shapes.all || all_rows > most_rows || all_rows == rows.count()) return read_cells(cells, rows, shape, values);
  reading_cells(cells, rows, shape, false, [&] {
    if (cells.whole.empty()) cells.column.getColumn(cells.whole);
  });
  const auto cell = static_cast<std::size_t>(shape.last());
  values.resize(casacore::IPosition(2, shape.last(), static_cast<ssize_t>(rows.count())));
  T* out = values.data();
  if (rows.contiguous()) {
    std::copy_n(cells.whole.data() + rows[0] * cell, rows.count() * cell, out);
  } else {
    for (std::uint64_t r = 0; r < rows.count(); ++r) out = std::copy_n(cells.whole.data() + rows[r] * cell, cell, out);
  }
}

/// Reads all correlations of the channels needed. Reading every correlation is faster than a strided slice of two of four.
template <typename T>
void ColumnReader::read_channels(const Cells<T>& cells, const Rows& rows, const Setup& setup,
                                 casacore::Array<T>& values) const {
  const std::size_t correlations = setup.correlation_types.size();
  const casacore::IPosition shape(2, static_cast<ssize_t>(correlations), static_cast<ssize_t>(setup.stored_channels));
  if (setup.channel_span() == setup.stored_channels) {
    read_cells(cells, rows, shape, values);
  } else {
    reading_cells(cells, rows, shape, true, [&] { read(cells.column, rows, channel_slice(setup, correlations), values); });
  }
}

/// True if a row has WEIGHT_SPECTRUM. Tiled cells of one shape are never empty where they are defined.
bool ColumnReader::spectrum_defined(casacore::rownr_t row) const {
  return spectrum_.column.isDefined(row) && (spectrum_.shapes.one || spectrum_.column.shape(row).product() > 0);
}

/// The number of `rows` that have WEIGHT_SPECTRUM.
std::size_t ColumnReader::spectra_defined(const Rows& rows) const {
  if (!has_spectrum_) return 0;
  if (spectrum_.shapes.all) return rows.count();
  std::size_t defined = 0;
  reading("WEIGHT_SPECTRUM", [&] {
    for (std::uint64_t r = 0; r < rows.count(); ++r) defined += spectrum_defined(rows[r]);
  });
  return defined;
}

/// Reads WEIGHT_SPECTRUM where its cell is defined, else WEIGHT.
void ColumnReader::read_weights(const Rows& rows, const Setup& setup, StoredRows& stored) {
  const std::size_t defined = spectra_defined(rows);
  stored.weight_per_channel = defined > 0;
  if (defined == rows.count()) {
    read_channels(spectrum_, rows, setup, stored.weight);
    return;
  }
  read_narrow(weight_, rows, casacore::IPosition(1, static_cast<ssize_t>(setup.correlation_types.size())), stored.weight);
  if (defined > 0) reading("WEIGHT_SPECTRUM", [&] { mix_weights(rows, setup, stored); });
}

/// Spreads WEIGHT over the channels, and puts WEIGHT_SPECTRUM where it is defined.
void ColumnReader::mix_weights(const Rows& rows, const Setup& setup, StoredRows& stored) const {
  const std::size_t span = setup.channel_span(), correlations = setup.correlation_types.size();
  casacore::Array<float> mixed(casacore::IPosition(3, static_cast<ssize_t>(correlations), static_cast<ssize_t>(span),
                                                   static_cast<ssize_t>(rows.count())));
  const casacore::IPosition shape(2, static_cast<ssize_t>(correlations), static_cast<ssize_t>(setup.stored_channels));
  float* out = mixed.data();
  const float* weight = stored.weight.data();
  for (std::uint64_t r = 0; r < rows.count(); ++r) {
    const casacore::rownr_t row = rows[r];
    if (spectrum_defined(row)) {
      require_cell(spectrum_, row, shape);
      const casacore::Array<float> cell = spectrum_.column.getSlice(row, channel_slice(setup, correlations));
      std::copy(cell.begin(), cell.end(), out);
    } else {
      for (std::size_t c = 0; c < span; ++c) std::copy_n(weight, correlations, out + c * correlations);
    }
    out += correlations * span;
    weight += correlations;
  }
  stored.weight.reference(mixed);
}

}  // namespace misfit::ms_io
