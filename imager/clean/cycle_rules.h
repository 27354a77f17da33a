#pragma once

#include <optional>
#include <string>

#include "imager/clean/clean.h"
#include "imager/data/image_statistics.h"

namespace misfit::imager {

/// Why CLEAN ends.
struct CleanEnding {
  CleanStop stop;
  std::string reason;
};

/// How deep the next minor cycle of CLEAN goes, how exact the residual after it must be, and when CLEAN ends: the rules of
/// CleanOptions and CleanInput, applied to what the cycles so far have left. It looks at no image but in its constructor.
class CycleRules {
 public:
  /// The rules of one run of CLEAN. Options and state are kept by reference: what the state is at a call decides.
  CycleRules(const CleanInput& input, const CleanOptions& options, const CleanState& state);

  /// The statistics of the dirty image's pixels.
  const ImageStatistics& dirty() const { return dirty_; }

  /// The options of the next minor cycle, but for its mask. In any case it goes down to where sidelobes of the brightest source
  /// could pass for sources; while components are trusted, it goes on to where sidelobes of all that it found could.
  MinorCycleOptions next() const;
  /// The depth below which threshold and nsigma let no minor cycle go that begins with the residual of `begun`, unless the
  /// noise falls as sources are removed. Cycles that would gain less than five percent are wasted: so all cycles go five
  /// percent below nsigma, since the noise falls as sources are removed, and five percent below the threshold after a cycle
  /// that went down to it.
  double last_depth(const MajorCycle& begun) const;

  /// True if a cycle reached the limit of iterations, or the last depth for the second time: the first time it leaves sources
  /// that sidelobes had hidden.
  bool is_likely_last(const MajorCycle& cycle) const;
  /// How exact the residual of a model must be for the minor cycles after one of this depth, which began with the residual of
  /// `before` and saw this noise last: the error shall be a small part of their depth. The error is in proportion to images of
  /// the data and of the model as if their phases were random.
  double accuracy_for_next(double depth_jy, double noise_jy, const MajorCycle& before) const;

  /// The reason to end CLEAN before another minor cycle; nothing where it goes on.
  std::optional<CleanEnding> ending(bool mask_is_empty) const;
  /// True if CLEAN would end with a larger residual than its best cycle's, in peak and mean square: cycles may leave somewhat
  /// more on the way to less. With automask it is false: masks grow, so that peaks cannot be compared.
  bool is_worse_than_best() const;

 private:
  const MajorCycle& now() const { return state_.cycles[state_.now]; }
  const MajorCycle& best() const { return state_.cycles[state_.best]; }
  bool components_are_trusted() const;
  double depth_fraction() const;
  double last_threshold(const MajorCycle& begun) const;
  bool is_at_last_depth(const MajorCycle& cycle) const;
  bool progresses() const;
  CleanEnding divergence() const;

  const CleanOptions& o_;
  const CleanState& state_;
  double max_sidelobe_;
  double data_jy_;
  double accuracy_;
  double psf_rms_;
  DoubtfulSidelobes doubtful_;
  ImageStatistics dirty_;
};

}  // namespace misfit::imager
