#pragma once

#include "imager/data/extent.h"
#include "imager/direct/sample_response.h"
#include "imager/plan/gridding_plan.h"
#include "imager/plan/planned_transform.h"
#include "imager/plan/taken_images.h"
#include "imager/transform/imaging.h"

namespace misfit::imager {

/// The response of samples to directions in the definition of a plan's images; null: all samples respond alike.
std::shared_ptr<const SampleResponse> response_of(const GriddingPlan& plan);

/// Errors of a dirty image that theory gives, relative to its RMS.
struct TheoreticalError {
  double expected_rms = 0;  ///< √(2E) for data with random phases, on the larger of the image's RMS and random data's RMS
  double bound_rms = 0;     ///< holds whatever the data
  double bound_max = 0;     ///< of the worst pixel, whatever the data
};

/// The errors of an image made from samples with these sums. The phase of w counts where the plan neglects it.
/// Images of a mosaic are made by its normalisation.
TheoreticalError theoretical_error(const GriddingPlan& plan, const SampleSums& sums, double image_rms, const NeglectedPhase& w,
                                   const Normalisation* by = nullptr);

struct AccurateImages {
  GriddingPlan plan;
  std::shared_ptr<const PlannedTransform> transform;
  DirtyImages images;
  double dirty_accuracy = 0;  ///< of the dirty images, where CLEAN alone is to begin with them; 0 = the plan's
  double judged_error = 0;  ///< over the images' RMS, where they were made twice: by theory, or twice the checked pixels' error
  bool promise_kept = true;  ///< whether the gridding error is within the accuracy, judged by the images made
};

/// Dirty images of the Stokes parameters that `plan` was asked for, and PSF, to its accuracy. Where an image turns out weak
/// against its data the kernel's error weighs more than it does on random data. There are two signs of this: the image may be
/// weaker than an image of random data; or weaker than the PSF's RMS times the visibilities' RMS, as when they belong to a
/// source outside, whose alias adds up in phase. The second may also be by noise, so that a few pixels are then compared with
/// direct sums (without w where the transform has no w axis). Where the error is too large the images are made once more with a
/// kernel that is more exact by the factor needed, or, where there is none, with the best. Stages timed: "plan", "check
/// pixels", and those of make_dirty_images.
///
/// `transform`, if there is one, is the transform of `plan`, by which other images have been made. Images that are taken are
/// not made, and need not be planned for; of a residual that is taken only the error of the comparison is known, see
/// ComparedPixels.
///
/// Dirty images that only `begin_clean` need not be as exact: where the PSF has a transform of its own, they are made together
/// with it, unless that leaves open whether they will be weak against their data.
AccurateImages make_accurate_images(const VisibilitySource& source, GriddingPlan plan, const Context& context,
                                    std::shared_ptr<const PlannedTransform> transform = nullptr, const TakenImages& taken = {},
                                    bool begin_clean = false);

}  // namespace misfit::imager
