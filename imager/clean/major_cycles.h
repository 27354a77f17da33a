#pragma once

#include <memory>
#include <vector>

#include "imager/clean/clean.h"

namespace misfit::imager {

/// Residual images [term], Jy/beam, of one term at least.
using Residuals = std::vector<std::shared_ptr<const Image>>;

/// What the loop over major cycles asks of that which is cleaned: one image, or the Taylor terms of one.
class CleanProblem {
 public:
  virtual ~CleanProblem() = default;
  /// Of the components that are found.
  virtual const std::vector<double>& scale_pixels() const = 0;
  /// Of data − model. Throws std::runtime_error where one is not finite.
  virtual Residuals residuals(const ComponentModel& model, int threads) = 0;
  /// Tells those who make residuals with it that there will be no more.
  virtual void end() const = 0;
  /// A minor cycle.
  virtual MinorCycleReport find(const Residuals& residuals, const MinorCycleOptions& options) const = 0;
};

/// CLEAN as clean() describes it, of any problem. Peaks, noise, thresholds and masks are those of the first term's residual.
CleanResult run_major_cycles(CleanProblem& problem, const CleanInput& input, const CleanOptions& options, CleanState state,
                             const CycleProgress& cycle_progress, StageTimes& times);

}  // namespace misfit::imager
