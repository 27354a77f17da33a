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

/// How the ranks of a run share it. With one channel, each rank has a part of the samples, and rank 0 the images of all
/// samples; with a cube, each rank makes some of its channels from all samples. Functions about all ranks are called by all
/// ranks.
class Sharing {
 public:
  /// `ranks` is kept by reference.
  Sharing(const imager::Ranks& ranks, bool of_channels) : ranks_(ranks), of_channels_(of_channels) {}

  /// True if this rank has whole images of what it makes.
  bool images_here() const { return of_channels_ || ranks_.first(); }
  /// The most channels of these that one rank makes.
  int channels_here(int channels) const { return (channels + ranks_.size() - 1) / ranks_.size(); }
  /// This rank's part of the samples; null: all of `set`.
  std::unique_ptr<ms_io::MeasurementSet> own_part(const ms_io::MeasurementSet& set) const;
  /// How far all selected samples reach; `own` is this rank's part. Ranks share the rows that are looked through.
  ms_io::SetReach reach(const ms_io::MeasurementSet& own) const;
  /// The number of all samples; this rank has `own` of them.
  double all_samples(double own) const;

  /// Throws std::invalid_argument, at all ranks, that names an option which they have unlike: ranks that make parts of one
  /// image may be started apart.
  void require_same(const nlohmann::json& option_values) const;
  /// Gives all ranks the models of `stokes` results of `terms` terms, which rank 0 has.
  void give_models(std::size_t stokes, int terms, std::vector<imager::CleanResult>& cleaned) const;
  /// The bytes that ranks exchanged: for an image rank 0's, in the time that its stage took; for channels all ranks'.
  imager::Decision traffic_decision(const imager::StageTimes& times) const;

 private:
  const imager::Ranks& ranks_;
  bool of_channels_;
};

/// The bytes that ranks send each other for an image.
struct ExchangeForecast {
  double first_bytes = 0;  ///< a rank gives for the dirty images and the PSF
  double cycle_bytes = 0;  ///< and for the residuals of a major cycle
};

/// The bytes for images of so many pixels: `images`, the PSF included, and `residuals`.
ExchangeForecast exchange_of(double pixels, int images, int residuals);

/// How the ranks share the samples, and what they will exchange.
imager::Decision sharing_decision(const ms_io::SampleSharing& sharing, const ExchangeForecast& exchange);

/// The bytes of the images of a channel, as ranks send them.
double channel_bytes(const RunWork& work);

/// How the ranks share the channels of a cube, in batches of so many; rank 0 gets `channel_bytes` of each channel.
imager::Decision channel_sharing_decision(int ranks, int channels, int channels_of_a_batch, double channel_bytes);

}  // namespace misfit::tools
