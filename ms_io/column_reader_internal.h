#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "ms_io/row_columns_internal.h"
#include "ms_io/spectral_frame_internal.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {

/// Rows of the main table as they are stored, of the channels from the first selected to the last one.
struct StoredRows {
  casacore::Vector<int> antenna1, antenna2;  ///< [row]
  casacore::Vector<bool> flag_row;           ///< [row] of the row, or of all its samples
  casacore::Array<double> uvw;               ///< [row][3]
  casacore::Array<casacore::Complex> data;   ///< [row][channel][correlation]
  casacore::Array<bool> flag;                ///< [row][channel][correlation]
  casacore::Array<float> weight;             ///< [row][channel][correlation] or [row][correlation]
  bool weight_per_channel = false;
  casacore::Vector<double> time_s;       ///< [row]; empty where no spectral frame is selected and no phase centre moves
  std::vector<double> frame_ratio;       ///< [row], see FrameRatio; empty where no spectral frame is selected
  std::vector<imager::RowSight> sights;  ///< [row]; empty where they are not asked for
};

/// Reads the columns that visibilities are formed of, some rows at a time.
class ColumnReader {
 public:
  explicit ColumnReader(std::shared_ptr<const OpenSet> source);

  /// Reads `rows`, whose cells all have the shape that `setup` says, into memory of `stored` that is used again. Throws
  /// std::runtime_error that names the column which cannot be read.
  void read_rows(const Rows& rows, const Setup& setup, StoredRows& stored);

 private:
  /// A column of arrays.
  template <typename T>
  struct Cells {
    std::string name;
    casacore::ArrayColumn<T> column;
    CellShapes shapes;
    casacore::Array<T> whole;  ///< all cells of a narrow column, once they are read
  };

  template <typename T>
  void attach(Cells<T>& cells, const std::string& name) const;
  template <typename Action>
  void reading(const std::string& column, const Action& action) const;
  template <typename T>
  void require_cell(const Cells<T>& cells, casacore::rownr_t row, const casacore::IPosition& shape) const;
  template <typename T>
  void require_shape(const Cells<T>& cells, const Rows& rows, const casacore::IPosition& shape, bool all) const;
  template <typename T, typename Action>
  void reading_cells(const Cells<T>& cells, const Rows& rows, const casacore::IPosition& shape, bool sliced,
                     const Action& action) const;
  template <typename T>
  void read_cells(const Cells<T>& cells, const Rows& rows, const casacore::IPosition& shape, casacore::Array<T>& values) const;
  template <typename T>
  void read_narrow(Cells<T>& cells, const Rows& rows, const casacore::IPosition& shape, casacore::Array<T>& values) const;
  template <typename T>
  void read_channels(const Cells<T>& cells, const Rows& rows, const Setup& setup, casacore::Array<T>& values) const;
  void read_flag_rows(const Rows& rows, StoredRows& stored) const;
  bool spectrum_defined(casacore::rownr_t row) const;
  std::size_t spectra_defined(const Rows& rows) const;
  void read_weights(const Rows& rows, const Setup& setup, StoredRows& stored);
  FrameRatio& frame_ratio(const Setup& setup, int observation);
  void find_frame_ratios(const Rows& rows, const Setup& setup, StoredRows& stored);
  void mix_weights(const Rows& rows, const Setup& setup, StoredRows& stored) const;

  std::shared_ptr<const OpenSet> source_;
  casacore::ScalarColumn<int> antenna1_, antenna2_, observation_;
  bool several_observations_ = false;
  casacore::ScalarColumn<double> time_;
  bool needs_time_ = false;
  /// [the window's frame, the field, see Setup::field, and OBSERVATION_ID]
  std::map<std::tuple<std::string, int, int>, std::unique_ptr<FrameRatio>> ratio_;
  casacore::ScalarColumn<bool> flag_row_;
  bool flag_row_is_dear_ = false;
  Cells<double> uvw_;
  Cells<casacore::Complex> data_;
  Cells<bool> flag_;
  Cells<float> weight_, spectrum_;
  bool has_spectrum_ = false;
};

}  // namespace misfit::ms_io
