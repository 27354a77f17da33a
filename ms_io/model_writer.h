#pragma once

#include <complex>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "imager/visibilities.h"
#include "ms_io/measurement_set.h"

namespace misfit::ms_io {

/// Computes the Stokes I visibilities [row][channel], in Jy, at the coordinates given.
using Predict = std::function<std::vector<std::complex<double>>(const imager::SampleCoordinates&)>;

/// A column that predicted visibilities go into. The short names data, corrected and model stand for DATA, CORRECTED_DATA and
/// MODEL_DATA.
struct ModelColumn {
  std::string name = "MODEL_DATA";
  std::string subtracted_from = "";  ///< column of the data: data − model is written. Empty: the model itself
  bool may_exist = true;             ///< and is then overwritten where the selection lies
};

struct ModelWriteReport {
  std::uint64_t rows = 0;
  std::uint64_t samples = 0;             ///< Stokes samples: rows × channels
  std::uint64_t nonfinite_uvw_rows = 0;  ///< rows for which the model counts as 0
};

/// Throws what write_model would where the MeasurementSet at `path`, or `column` of it, cannot be written.
void require_writable(const std::string& path, const ModelColumn& column = {});

/// Writes predicted visibilities into `column` of the MeasurementSet at `path`, for every sample selected whatever its flags
/// and weights, auto-correlations included. XX, YY, RR and LL get I, or lose it; cross-hand correlations get 0, or the data
/// as they are. A column that does not exist is created with the shape and storage of DATA; rows and channels outside the
/// selection are left alone, and hold 0, or the data, in a new column. `column` may be neither DATA nor what the data are read
/// from, since nobody could tell afterwards where a run was cut short. `progress(done, total)` is called after every block, in
/// samples. Throws std::runtime_error as MeasurementSet does (but correlations from which I cannot be formed are written all
/// the same), and std::invalid_argument when `predict` returns the wrong number of values. It is asked for about
/// `block_samples` samples at a time, in a thread of its own while the block before is written.
ModelWriteReport write_model(const std::string& path, const Selection& selection, const ModelColumn& column,
                             const Predict& predict, const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                             std::uint64_t block_samples = MeasurementSet::usual_block_samples);

}  // namespace misfit::ms_io
