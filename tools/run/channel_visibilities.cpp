#include "tools/run/channel_visibilities.h"

#include <algorithm>
#include <utility>

#include "imager/data/handed_over.h"

namespace misfit::tools {

ms_io::FrequencyRange ChannelVisibilities::frequencies_of(const imager::PlaneRange& range) const {
  const imager::FrequencyBand band = sampling_->axis.planes(range.first, range.count);
  return {band.low_hz, band.high_hz};
}

/// The part of the set that these channels need; null where it has nothing for them. Samples that earlier channels need, too,
/// are counted there.
std::unique_ptr<ms_io::MeasurementSet> ChannelVisibilities::part_of(const imager::PlaneRange& range) const {
  std::optional<ms_io::FrequencyRange> counted;
  if (range.first > 0) counted = frequencies_of({0, range.first});
  return set_.part(frequencies_of(range), counted);
}

std::string ChannelVisibilities::numbers_of(const imager::PlaneRange& range) const {
  const std::string of = " of " + std::to_string(sampling_->axis.channels);
  if (range.count == 1) return std::to_string(range.first) + of;
  return std::to_string(range.first) + " to " + std::to_string(range.first + range.count - 1) + of;
}

std::string ChannelVisibilities::work_on(const imager::PlaneRange& batch) const {
  return (batches_.read_again ? "image " : "images ") + numbers_of(batch);
}

/// Gathers the visibilities of some channels, unless they are there.
void ChannelVisibilities::gather(const imager::PlaneRange& batch, ProgressLine& progress, imager::StageTimes& times) {
  if (gathered_) return;
  first_ = batch.first;
  progress.begin("planes " + numbers_of(batch));
  if (const auto part = part_of(batch)) {
    const auto update = [&](std::uint64_t done, std::uint64_t total) { progress.update(done, total); };
    gathered_ = imager::gather_planes(*part, *sampling_, batch, {threads_, &times, update});
  } else {
    gathered_.emplace();
  }
  progress.end();
}

void ChannelVisibilities::look_through(const std::vector<imager::PlaneRange>& batches,
                                       const std::function<void(const imager::VisibilitySource&)>& visit,
                                       ProgressLine& progress, imager::StageTimes& times) {
  for (const imager::PlaneRange& batch : batches) {
    if (batches_.read_again) {
      if (const auto part = part_of(batch)) visit(imager::PlaneView(*part, *sampling_, batch.first));
      continue;
    }
    gather(batch, progress, times);
    for (int i = 0; i < batch.count; ++i) visit(gathered_->plane(i));
    if (batch.count < sampling_->axis.channels) gathered_.reset();
  }
}

void ChannelVisibilities::begin(const imager::PlaneRange& batch, ProgressLine& progress, imager::StageTimes& times) {
  if (sampling_ == nullptr || batches_.read_again) return;
  gather(batch, progress, times);
  count(gathered_->counts().read);
  outside_channels_ += gathered_->counts().outside_planes;
}

std::unique_ptr<ChannelSamples> ChannelVisibilities::take(int channel) {
  if (sampling_ == nullptr) return std::make_unique<ChannelSamples>(set_, streaming_);
  if (batches_.read_again) {
    auto part = part_of({channel, 1});
    if (!part) return nullptr;
    auto view = std::make_unique<imager::PlaneView>(*part, *sampling_, channel);
    return std::make_unique<ChannelSamples>(std::move(part), std::move(view),
                                            imager::StreamingOptions{.keep = false, .ahead = 0, .uv_reach_lambda = 0});
  }
  imager::StoredVisibilities samples = gathered_->take(channel - first_);
  if (samples.samples() == 0) return nullptr;
  return std::make_unique<ChannelSamples>(nullptr, std::make_unique<imager::HandedOver>(std::move(samples)),
                                          imager::StreamingOptions{.keep = true, .ahead = 0, .uv_reach_lambda = 0});
}

void ChannelVisibilities::count(const imager::SampleCounts& counts) {
  imager::SampleCounts read = counts;
  read.used = 0;
  counts_ += read;
}

}  // namespace misfit::tools
