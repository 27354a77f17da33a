#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "imager/data/visibilities.h"
#include "ms_io/measurement_set.h"

namespace misfit::ms_io {

/// Visibilities of a model.
struct StokesVisibilities {
  std::array<std::vector<std::complex<double>>, 4> plane;  ///< I, Q, U, V, each [row][channel] in Jy, or empty where it is 0

  StokesVisibilities() = default;
  /// An unpolarised model.
  StokesVisibilities(std::vector<std::complex<double>> stokes_i) { plane[0] = std::move(stokes_i); }
};

/// Computes a model's visibilities at the coordinates given.
using Predict = std::function<StokesVisibilities(const imager::SampleCoordinates&)>;

/// How predictions are asked for.
struct PredictionPace {
  std::uint64_t block_samples = MeasurementSet::usual_block_samples;  ///< about so many samples at a time
  int at_once = 1;                                                    ///< by so many threads
  /// Where it is given, coordinates have the sight of each row, by ids of ANTENNA and FIELD, and directions in this direction's
  /// frame.
  std::optional<imager::SkyDirection> sights_from = {};
};

/// By this a run recognises a column that was not written to its end.
struct ModelOrigin {
  std::string command;  ///< that writes it, as people are told, but for the selection: "misfit predict --model a.fits"
  std::uint64_t fingerprint = 0;                 ///< of the model and of what changes its visibilities; 0: not known
  std::function<void(const std::string&)> tell;  ///< gets a sentence on what an earlier run left, and what becomes of it
  std::uint64_t model = 0;  ///< a fingerprint of the model alone, however it is predicted; 0: use `fingerprint`
};

/// A column that predicted visibilities go into. The short names data, corrected and model stand for DATA, CORRECTED_DATA and
/// MODEL_DATA.
struct ModelColumn {
  std::string name = "MODEL_DATA";
  std::string subtracted_from = "";  ///< column of the data: data − model is written. Empty: the model itself
  bool may_exist = true;             ///< and is then overwritten where the selection lies
  ModelOrigin origin = {};

  /// True if data − model replaces the data.
  bool in_place() const;
};

/// `column` with its short names spelt out.
ModelColumn spelt_out(const ModelColumn& column);

struct ModelWriteReport {
  std::uint64_t set_rows = 0;            ///< of the set, selected or not
  std::uint64_t rows = 0;                ///< that hold the model now
  std::uint64_t rows_before = 0;         ///< of these, written by an earlier run that this one continued
  std::uint64_t samples = 0;             ///< Stokes samples: rows × channels
  std::uint64_t nonfinite_uvw_rows = 0;  ///< rows for which the model counts as 0
  ZeroColumn zeros = {};                 ///< of the data that the model was subtracted from, where this run subtracted from all
};

/// Cells that a selection leaves out of a column.
struct UnselectedCells {
  std::uint64_t set_rows = 0;  ///< of the set, selected or not
  std::uint64_t rows = 0;      ///< that are not selected
  bool channels = false;       ///< true if some rows that are selected have channels that are not
  bool column_is_new = false;  ///< true if the set has no such column yet
};

/// The cells of `column` that `selection`, of one set, leaves out; {} without reading the set where it selects all. Throws what
/// write_model would for a wrong or empty selection.
UnselectedCells unselected_cells(const std::string& path, const Selection& selection, const ModelColumn& column = {});

/// "MODEL_DATA of `path` is incomplete: 12 of 30 rows were written before by …", or nothing where no run was cut short while it
/// wrote that column, or another program has written all of it since, as up to 16 cells spread over the selection show. Throws
/// std::runtime_error where `path` is no MeasurementSet.
std::string incomplete_column(const std::string& path, const std::string& column);

/// Throws what write_model would where the MeasurementSet at `path`, or `column` of it, cannot be written.
void require_writable(const std::string& path, const ModelColumn& column = {});

/// Writes predicted visibilities into `column` of the MeasurementSet at `path`, for every sample selected whatever its flags
/// and weights, auto-correlations included. Each correlation gets its response to the model's Stokes parameters, XX = I + Q and
/// so on, or loses it. A column that does not exist is created, uncompressed, with the shape and tiling of DATA; rows and
/// channels outside the selection are left alone, and hold 0, or the data, in a new column and in cells that had no shape.
/// `column` may not be DATA.
///
/// A run that ends early, even killed, leaves a set that opens, and a record of the rows that are written. The next one with
/// the same model, options and selection goes on there, unless these rows, or the data of these rows, have changed since; any
/// other begins anew, but is refused where data − model replaces the data.
///
/// A complete run that subtracts leaves a record of the model that the column lacks from then on. ModelOrigin::tell gets a
/// sentence on models that the data lack already; where data − model replaces the data, the same model and selection are
/// refused.
///
/// `progress(done, total)` is called after every block, in samples. Throws std::runtime_error as MeasurementSet does (but
/// correlations from which I cannot be formed are written all the same), where another process has locked the set for more than
/// a few seconds, and where the column is missing in a table that refers to the rows of others; std::invalid_argument when
/// `predict` returns the wrong number of values. `predict` is called in threads of its own while earlier blocks are written.
ModelWriteReport write_model(const std::string& path, const Selection& selection, const ModelColumn& column,
                             const Predict& predict, const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                             const PredictionPace& pace = {});

}  // namespace misfit::ms_io
