#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "imager/numerics/stage_times.h"
#include "imager/plan/gridding_plan.h"

namespace misfit::tools {

/// The numbers that the time of a run depends on. CLEAN's own are known only afterwards, and are 0 before.
struct RunWork {
  const imager::GriddingPlan* plan = nullptr;
  double rows = 0;  ///< of the visibilities
  double samples = 0;
  int channels = 1;  ///< of the image; each has a part of the samples, and all that follows is for each channel
  int workers = 1;   ///< channels made at a time by all ranks, which share their threads
  int ranks = 1;     ///< that share the samples of an image, where `samples` are one rank's, or the channels of a cube
  bool kept = true;  ///< whether visibilities are read once, or in every pass
  double pixels = 0;
  int images = 2;    ///< files
  int pictures = 2;  ///< drawn
  int threads = 1;
  double verified = 0;          ///< pixels and samples of --verify
  bool residual_taken = false;  ///< from a file; `plan` says whether a PSF is made
  std::string deconvolver;
  int terms = 1;         ///< Taylor terms
  bool density = false;  ///< whether weights follow from the samples' density
  bool tapered = false;
  bool primary_beam = false;
  double components = 0;
  double major_cycles = 0;                      ///< that predicted and subtracted
  const imager::GriddingPlan* wider = nullptr;  ///< of the field that is searched for sources outside; null without
};

/// Seconds of a stage.
struct StageSeconds {
  std::string stage;
  std::string kind;  ///< of work: stages of one kind share what was learned
  double seconds = 0;
};

/// The seconds of each stage after the plan, by counts of operations and fixed constants of one machine. Pictures take what
/// they add to the run that goes on meanwhile.
std::vector<StageSeconds> counted_seconds(const RunWork& work);

double total_seconds(const std::vector<StageSeconds>& stages);

/// The work with so many major cycles, of so many components each.
RunWork with_cycles(RunWork work, int cycles, int components);

/// Expects the seconds of runs from their counts of operations and from how long earlier runs on this machine really took: for
/// each kind of work a factor for runs of about the same size (powers of two of samples and pixels), of the size nearest to a
/// run's. They are kept in a file, and every run makes them a little better. They decide nothing but what is printed.
class TimeForecast {
 public:
  /// Reads times.json in `folder`, if it is there and of this machine; an empty path keeps nothing.
  explicit TimeForecast(const std::filesystem::path& folder);

  std::vector<StageSeconds> expected(const RunWork& work) const { return expected(work, work); }
  /// The seconds expected by the speed of runs as large as `as_large`, so that works of several sizes compare.
  std::vector<StageSeconds> expected(const RunWork& work, const RunWork& as_large) const;
  /// True if runs like this have been timed here.
  bool knows(const RunWork& work) const;
  /// Takes in what a run took, and keeps it. Stages of less than 5 ms say nothing.
  void learn(const RunWork& work, const imager::StageTimes& took);

 private:
  struct Factor {
    double log = 0;  ///< of seconds taken over seconds counted
    int runs = 0;
  };

  /// The factor's logarithm of the kind at the size nearest to this one; 0 where it was never timed.
  double log_factor(const std::string& kind, const std::string& size) const;

  std::filesystem::path file_;
  std::map<std::string, Factor> factor_;  ///< by kind, which tells that it was timed, and by kind and size
};

}  // namespace misfit::tools
