#pragma once

#include <functional>
#include <string>
#include <vector>

#include "imager/clean/clean.h"
#include "imager/data/geometry.h"
#include "imager/data/stokes.h"
#include "ms_io/measurement_set.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

/// The models that --savemodel writes.
struct SavedModel {
  const imager::ImageGeometry& geometry;
  int threads = 1;
  const std::vector<imager::Stokes>& stokes;              ///< that saves_model() holds for
  const std::vector<imager::CleanResult>& cleaned;        ///< [Stokes]
  std::string option_values;                              ///< by which a column that was cut short is recognised
  std::function<void(const std::string& sentence)> tell;  ///< what becomes of such a column
  imager::TaylorExpansion expansion{};                    ///< of the models' spectra
};

/// True if a column can be made of images of these: I, Q, U and V, or parallel hands of one kind of feed.
bool saves_model(const std::vector<imager::Stokes>& stokes);

/// A warning that names what MODEL_DATA of `set` has 0 for, since there is no image of it: beside images of hands the other
/// correlations, beside Stokes parameters the others that correlations respond to. Empty where all is imaged, or I alone, which
/// makes an unpolarised model.
std::string left_out_of_model_warning(const std::vector<imager::Stokes>& stokes, const ms_io::MeasurementSet& set);

/// Writes the models' visibilities into MODEL_DATA of each set of the run, about its own phase centre: of parallel hands as the
/// visibilities of I = (a + b) / 2 and of Q or V = (a − b) / 2, where a is XX or RR and b is YY or LL, and 0 without an image.
/// Called by all ranks, which have the same models: they predict, and the first writes. Returns the first rank's lines on what
/// was written. Throws what ms_io::write_model does.
std::string save_model(const ImageOptions& options, const SavedModel& model, const imager::Ranks& ranks,
                       const imager::Progress& progress);

}  // namespace misfit::tools
