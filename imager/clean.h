#pragma once

#include <functional>
#include <string>
#include <vector>

#include "imager/imaging.h"

namespace misfit::imager {

/// Parameters of CLEAN with the names and meaning of CASA's tclean.
struct CleanOptions {
  int max_iterations = 0;          ///< niter
  double gain = 0.1;               ///< part of a peak that a component takes
  double threshold_jy = 0;         ///< stop when the peak residual is not above it
  double nsigma = 0;               ///< or not above this many times the robust noise
  double cycle_factor = 1;         ///< a minor cycle goes down to the peak × largest sidelobe × cycle factor …
  double min_psf_fraction = 0.05;  ///< … that fraction of the peak clamped to [min, max]
  double max_psf_fraction = 0.8;
  int cycle_iterations = -1;           ///< cycleniter: components that a minor cycle finds at most; −1 = no limit
  int max_major_cycles = -1;           ///< nmajor; −1 = no limit
  const Image* mask = nullptr;         ///< where components may lie, see mask.h; null = everywhere
  const Image* start_model = nullptr;  ///< Jy/pixel, what components are added to; null = nothing
  int threads = 1;
  std::function<bool()> stop_requested;  ///< the user's wish to end; may be empty
};

/// Why CLEAN ended, with tclean's codes.
enum class CleanStop {
  iteration_limit = 1,
  threshold = 2,
  user = 3,
  no_change = 4,
  diverging = 5,
  empty_mask = 7,
  nsigma = 8,
  major_cycle_limit = 9,
};

/// The state after one major cycle.
struct MajorCycle {
  int iterations = 0;           ///< components found so far
  double peak_residual_jy = 0;  ///< within the mask
  double rms_jy = 0;            ///< robust noise of the residual, within the mask and without
  double model_flux_jy = 0;
  double cycle_threshold_jy = 0;  ///< how deep its minor cycle was to go, in Jy/beam
  std::string ended;              ///< why its minor cycle ended; empty before the first
};

struct CleanReport {
  int iterations = 0;
  CleanStop stop = CleanStop::iteration_limit;
  std::string stop_reason;
  double max_sidelobe = 0;         ///< of the PSF, outside the fitted beam
  std::vector<MajorCycle> cycles;  ///< [0] is the state before the first
  std::size_t kept = 0;            ///< the cycle whose model was kept; the last unless CLEAN diverged

  const MajorCycle& final_state() const { return cycles[kept]; }
};

struct CleanResult {
  Image model;     ///< Jy/pixel
  Image residual;  ///< Jy/beam, of this model
  CleanReport report;
};

/// Told after every major cycle.
using CycleProgress = std::function<void(const MajorCycle&)>;

/// Largest magnitude of the PSF once the Gaussian `beam` is taken off; NaN does not count.
double largest_sidelobe(const Image& psf, const Image& beam);

/// Cotton–Schwab CLEAN (Schwab 1984, AJ 89, 1076): minor cycles find components in the image; major cycles predict the model's
/// visibilities, subtract them from the data, and image what is left. `max_sidelobe` is the largest of the PSF. When the
/// residual grows to more than three times the smallest seen, the best model is kept and CLEAN stops as diverging. Stages
/// timed: "minor cycles", and those of make_residual_image. Throws std::runtime_error when a residual's peak is not finite.
CleanResult clean(const VisibilitySource& source, const Transform& transform, const DirtyImages& images, double max_sidelobe,
                  const CleanOptions& options, const Progress& progress, const CycleProgress& cycle_progress,
                  StageTimes& times);

}  // namespace misfit::imager
