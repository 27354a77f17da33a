#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "imager/data/extent.h"
#include "imager/plan/accurate_imaging.h"
#include "tools/base/progress.h"
#include "tools/run/channel_visibilities.h"
#include "tools/run/clean_stage.h"
#include "tools/run/image_options.h"
#include "tools/run/run_report.h"
#include "tools/run/taken_files.h"
#include "tools/run/taylor_stage.h"

namespace misfit::tools {

/// Takes the words and times of a run while it makes its one channel. Each of several channels keeps its own, and the run tells
/// them one channel after the other.
struct ToldAsItGoes {
  ProgressLine& progress;
  imager::StageTimes& times;
  std::function<void(const std::string& sentence)> warn;
};

/// Data that the channels of a run share. References must outlive it.
struct ChannelScene {
  const ImageOptions& options;
  const StateOptionValues& option_values;
  const imager::ImageHeader& header;
  imager::UvwReach reach;
  int threads = 1;                     ///< for each channel
  bool images_here = true;             ///< or at rank 0 alone
  std::size_t pointings = 1;           ///< of a mosaic
  bool whole_band = true;              ///< whether it has one channel, of the whole band
  const TakenFiles* taken = nullptr;   ///< null where all images are made
  const std::atomic<bool>& given_up;   ///< whether channels are of no use any more: their work then ends in Interrupted
  const ToldAsItGoes* told = nullptr;  ///< null where each keeps what it has to tell
};

/// The results of a channel, for the run that puts channels together.
struct MadeChannel {
  ChannelReport report;
  std::uint64_t outside_grid = 0;              ///< samples
  double components = 0;                       ///< of CLEAN, of this run
  double major_cycles = 0;                     ///< that predicted and subtracted
  std::vector<std::string> warnings;           ///< in their order
  std::vector<std::string> doubts;             ///< doubts that several channels may have, in the same words
  imager::StageTimes times;                    ///< none where it told as it went
  std::vector<imager::CleanResult> cleaned{};  ///< [Stokes], the models that --savemodel needs; not sent to other ranks

  bool empty() const { return report.sums.used == 0; }
  /// True if the user ended its CLEAN.
  bool stopped() const;
};

/// Makes one channel, of all Stokes parameters: weights, dirty images and PSF, their errors, beam, CLEAN. The steps are called
/// in the order in which they stand here, and put their results into report(). Stages timed: "weights", "statistics", "verify",
/// "fit beam", and those of the imager's functions.
class ChannelRun {
 public:
  /// `scene` is kept by reference. Without samples, null, it has nothing but its number and frequency.
  ChannelRun(const ChannelScene& scene, int channel, std::unique_ptr<ChannelSamples> samples);

  /// Weighs the samples, with a pass over them where weights follow from their density.
  void weigh();
  /// Weighs the samples with weights made before.
  void weigh(std::shared_ptr<const imager::ImagingWeights> weights);
  /// Makes the dirty images and the PSF, by `transform`, if it is given, which is the transform of `plan`. Throws
  /// std::runtime_error where images taken from files are not images of the samples.
  void make_dirty(imager::GriddingPlan plan, std::shared_ptr<const imager::PlannedTransform> transform);
  /// Makes the images of further Taylor terms, which CLEAN then has too.
  void make_terms();
  /// Compares a residual that was taken with the residual of the start model, if there is one: a prediction for each Stokes
  /// parameter.
  void check_start();
  void verify();
  /// Chooses the beams. For rank 0, which has the PSF.
  void choose_beams();
  /// Makes this rank's parts of residuals, while rank 0 is in clean().
  void follow_clean();
  /// Gets CLEAN of this channel ready, with its primary beam where masks or their noise keep within that, else null.
  void begin_clean(std::unique_ptr<CleanStage> stage, const imager::Image* primary_beam);
  bool may_clean() const { return stage_ != nullptr; }
  /// Cleans one Stokes parameter after the other. Returns the stage, which may serve another channel.
  std::unique_ptr<CleanStage> clean();
  /// Frees the samples, and what transforms them.
  void release_samples();

  imager::Context context();
  imager::StageTimes& times();
  ProgressLine& progress();
  void warn(const std::string& sentence);

  bool has_samples() const { return samples_ != nullptr; }
  imager::StreamedVisibilities& samples() { return samples_->stream(); }
  const ImageOptions& options() const { return scene_.options; }
  const imager::ImageHeader& header() const { return scene_.header; }
  int threads() const { return scene_.threads; }
  ChannelReport& report() { return made_.report; }
  imager::AccurateImages& images() { return images_; }
  std::vector<imager::CleanResult>& cleaned() { return cleaned_; }  ///< [Stokes], or none
  /// Null where CLEAN may go everywhere, makes its own, or is over.
  const imager::Image* mask(std::size_t stokes) const { return stage_ ? stage_->mask(stokes) : nullptr; }
  /// √(W / max W) of a mosaic; null unless it is one.
  const imager::Image* mosaic_beam() const {
    const imager::MosaicView* const view = images_.images.normalisation.mosaic();
    return view == nullptr ? nullptr : view->primary_beam.get();
  }
  TaylorStage* taylor() { return taylor_ ? &*taylor_ : nullptr; }  ///< null where there is one term
  MadeChannel& made() { return made_; }

 private:
  imager::TakenImages taken();
  TakenTerms taken_terms();
  void compare_residuals(std::size_t stokes, const imager::ComparedPixels& pixels, const std::vector<imager::Image>& values);
  /// Calls `act`; where it finds that a taken image is not of the samples, the error names its file.
  template <typename Act>
  void naming_taken(const Act& act) {
    try {
      act();
    } catch (const imager::UnlikeSamples& unlike) {
      scene_.taken->refuse(unlike);
    }
  }
  void predict_noise();
  void count_cycle(const imager::CleanState& state);
  imager::ImagedData imaged(std::size_t stokes);
  imager::CleanResult clean(std::size_t stokes);
  /// Warns of what is doubtful about the last CLEAN, or keeps that for planes to be told together.
  void doubt_clean(std::size_t stokes);

  const ChannelScene& scene_;
  std::unique_ptr<ChannelSamples> samples_;
  std::string name_;     ///< the channel in messages, " of plane 12"; empty where there is one
  ProgressLine silent_;  ///< of several channels, whose stages would fill the screen
  std::shared_ptr<const imager::ImagingWeights> weights_;  ///< until the noise is predicted; null where they are the data's
  imager::AccurateImages images_;
  TakenPlanes former_;                 ///< planes taken from files, until they stand among the images
  std::optional<TaylorStage> taylor_;  ///< none where there is one term
  std::unique_ptr<CleanStage> stage_;  ///< from begin_clean() to clean()
  std::optional<int> iterations_;      ///< of the Stokes parameter in CLEAN, so far
  std::vector<imager::CleanResult> cleaned_;
  MadeChannel made_;
};

}  // namespace misfit::tools
