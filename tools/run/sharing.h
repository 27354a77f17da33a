#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "imager/clean/clean.h"
#include "imager/data/extent.h"
#include "imager/plan/plan.h"
#include "ms_io/measurement_set.h"
#include "tools/run/time_forecast.h"

namespace misfit::tools {

/// How the ranks of a run share it. Of its one channel each has a part of the samples, and rank 0 the images that come of all;
/// of a cube's channels each makes some, from all samples. What is said of all ranks is called by all.
class Sharing {
 public:
  /// `ranks` is kept by reference.
  Sharing(const imager::Ranks& ranks, bool of_channels) : ranks_(ranks), of_channels_(of_channels) {}

  /// Whether this rank has whole images of what it makes.
  bool images_here() const { return of_channels_ || ranks_.first(); }
  /// Of so many, those that a rank makes at most.
  int channels_here(int channels) const { return (channels + ranks_.size() - 1) / ranks_.size(); }
  /// What this rank has of the samples; null: all of `set`.
  std::unique_ptr<ms_io::MeasurementSet> own_part(const ms_io::MeasurementSet& set) const;
  /// How far all that is selected reaches; `own` is this rank's part. Looking through it, ranks share the rows.
  imager::UvwReach reach(const ms_io::MeasurementSet& own) const;
  /// All samples, of which this rank has so many.
  double all_samples(double own) const;

  /// Ranks may be started apart, and make parts of one image: throws std::invalid_argument, at all of them, that names the
  /// option which they have unlike.
  void require_same(const nlohmann::json& option_values) const;
  /// Gives all ranks the models of `stokes` results of `terms` terms, which rank 0 has.
  void give_models(std::size_t stokes, int terms, std::vector<imager::CleanResult>& cleaned) const;
  /// What they exchanged: of an image what rank 0 gave, in the time that its stage took; of channels what all gave.
  imager::Decision traffic_decision(const imager::StageTimes& times) const;

 private:
  const imager::Ranks& ranks_;
  bool of_channels_;
};

/// What ranks send each other of an image.
struct ExchangeForecast {
  double first_bytes = 0;  ///< a rank gives for the dirty images and the PSF
  double cycle_bytes = 0;  ///< and for the residuals of a major cycle
};

/// Of images of so many pixels: `images` with the PSF, and `residuals`.
ExchangeForecast exchange_of(double pixels, int images, int residuals);

/// How the ranks share the samples, and what they will exchange.
imager::Decision sharing_decision(const ms_io::SampleSharing& sharing, const ExchangeForecast& exchange);

/// Of the images of a channel, as ranks send them.
double channel_bytes(const RunWork& work);

/// How the ranks share the channels of a cube, in batches of so many, of each of which rank 0 gets so many bytes.
imager::Decision channel_sharing_decision(int ranks, int channels, int channels_of_a_batch, double channel_bytes);

}  // namespace misfit::tools
