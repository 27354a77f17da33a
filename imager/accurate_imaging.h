#pragma once

#include "imager/extent.h"
#include "imager/gridding_plan.h"
#include "imager/imaging.h"

namespace misfit::imager {

/// Errors of a dirty image that theory gives, relative to its RMS.
struct TheoreticalError {
  double expected_rms = 0;  ///< √(2E) for data with random phases, on the larger of the image's RMS and that of random data
  double bound_rms = 0;     ///< holds whatever the data
  double bound_max = 0;     ///< of the worst pixel, whatever the data
};

/// The errors of images made from samples with these sums. The neglected w phase counts.
TheoreticalError theoretical_error(const GriddingPlan& plan, const SampleSums& sums, double image_rms, const NeglectedPhase& w);

/// √(mean I²).
double root_mean_square(const Image& image);

struct AccurateImages {
  GriddingPlan plan;
  std::unique_ptr<Transform> transform;
  DirtyImages images;
  bool promise_kept = true;  ///< whether the kernel's expected error is within the accuracy, judged by the image that came out
};

/// Dirty image and PSF to the accuracy asked. Where the image turns out weak against the data (a strong source outside, say)
/// the same kernel errors weigh more; it is then made once more with a kernel that is right by as much, or, where there is
/// none, by the best.
AccurateImages make_accurate_images(const VisibilitySource& source, const GriddingRequest& request, const Progress& progress,
                                    StageTimes& times);

}  // namespace misfit::imager
