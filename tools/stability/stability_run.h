#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "imager/clean/clean.h"
#include "imager/data/geometry.h"
#include "imager/data/visibilities.h"
#include "imager/plan/accurate_imaging.h"

namespace misfit::tools {

/// An observation to be imaged and cleaned as `misfit image` would.
struct StabilityCase {
  std::string name;
  std::shared_ptr<const imager::VisibilityBlock> block;
  std::uint64_t repeats = 1;  ///< how often the block comes
  imager::ImageGeometry geometry;
  double threshold_jy = 0.01;  ///< of CLEAN
  int max_iterations = 300;
  int max_major_cycles = -1;
};

/// Measured against direct sums in extended precision, relative to the RMS of the dirty image or of predicted visibilities.
struct ExtendedError {
  double rms = 0;          ///< of the dirty image, over random pixels
  double max = 0;          ///< the largest among them
  double predict_rms = 0;  ///< of prediction, over random samples
};

/// The results of a case.
struct StabilityOutcome {
  std::string name;
  double accuracy = 0;  ///< asked, ε
  std::string refusal;  ///< why the plan refused it; the other results are then of the most exact way there is
  bool single = false;  ///< the grid's precision
  bool promise_kept = true;
  imager::TheoreticalError theory;
  ExtendedError measured;
  bool finite = true;      ///< every pixel of the dirty image and the PSF
  int max_iterations = 0;  ///< of CLEAN
  imager::CleanReport clean;

  /// True if image and prediction are as exact as asked, or the run says that they may not be.
  bool honest() const;
  /// True if RMS and worst pixel of the image lie within the strict bounds, which hold whatever the data.
  bool within_bounds() const { return measured.rms <= theory.bound_rms && measured.max <= theory.bound_max; }
  double peak_before_jy() const { return clean.cycles.front().peak_residual_jy; }
  double peak_after_jy() const { return clean.final_state().peak_residual_jy; }
};

/// Images and cleans every case by gridding, with a w axis where the phase of w matters: at 1e-4, which leads to single
/// precision, and at 1e-9, which takes double.
std::vector<StabilityOutcome> run_cases(const std::vector<StabilityCase>& cases);

}  // namespace misfit::tools
