#pragma once

#include <functional>

#include "imager/image.h"

namespace misfit::imager {

struct MinorCycleOptions {
  double gain = 0.1;
  int max_iterations = 0;
  double threshold_jy = 0;  ///< stop when no pixel exceeds it in magnitude
  int threads = 1;
  std::function<bool()> stop_requested;  ///< asked now and then; may be empty
};

struct MinorCycleReport {
  int iterations = 0;
  double peak_jy = 0;  ///< magnitude of the brightest pixel left
  double flux_jy = 0;  ///< sum of the components added to the model
};

/// Högbom's CLEAN (Högbom 1974, A&AS 15, 417): again and again the brightest pixel, positive or negative, gives `gain` times
/// its value to the model, and that times the PSF is subtracted from all pixels. `psf` has the size of the image and its peak,
/// 1, at the centre pixel; what lies beyond it, or is NaN, counts as 0. Pixels of `residual` that are NaN are never cleaned.
/// Works on a single-precision copy of `residual`; the components are added to `model`. Stops, too, when the peak exceeds three
/// times that of the start: what lies outside the PSF's reach can make it grow without end.
MinorCycleReport hogbom(const Image& residual, const Image& psf, const MinorCycleOptions& options, Image& model);

}  // namespace misfit::imager
