#include "tools/run/channel_messages.h"

#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/utility.hpp>
#include <cereal/types/vector.hpp>
#include <utility>

#include "tools/base/packed.h"

// The members that are sent, in their order. cereal finds these functions by the types' namespaces.

namespace misfit::imager {

template <typename Archive>
void serialize(Archive& archive, PlaneIndex& at) {
  archive(at.channel, at.stokes);
}

template <typename Archive>
void serialize(Archive& archive, PlaneRange& range) {
  archive(range.first, range.count);
}

template <typename Archive>
void serialize(Archive& archive, Image& image) {
  archive(image.width, image.height, image.pixel);
}

template <typename Archive>
void serialize(Archive& archive, Beam& beam) {
  archive(beam.major_rad, beam.minor_rad, beam.position_angle_rad);
}

template <typename Archive>
void serialize(Archive& archive, SampleSums& sums) {
  archive(sums.used, sums.outside_grid, sums.weight, sums.weight_abs, sums.weight_square, sums.weight2_square);
}

template <typename Archive>
void serialize(Archive& archive, TheoreticalError& error) {
  archive(error.expected_rms, error.bound_rms, error.bound_max);
}

template <typename Archive>
void serialize(Archive& archive, PixelError& error) {
  archive(error.rms, error.max);
}

template <typename Archive>
void serialize(Archive& archive, Decision& decision) {
  archive(decision.item, decision.decision, decision.because);
}

template <typename Archive>
void serialize(Archive& archive, Peak& peak) {
  archive(peak.row, peak.column, peak.value);
}

template <typename Archive>
void serialize(Archive& archive, MaskExtension& masked) {
  archive(masked.threshold_jy, masked.by_sidelobes, masked.regions, masked.pruned, masked.grown_regions, masked.grown_pruned,
          masked.negative, masked.added);
}

template <typename Archive>
void serialize(Archive& archive, MajorCycle& cycle) {
  archive(cycle.iterations, cycle.peak_residual_jy, cycle.rms_jy, cycle.model_flux_jy, cycle.cycle_threshold_jy, cycle.ended,
          cycle.mean_square_jy2, cycle.accuracy, cycle.from, cycle.peak_anywhere_jy, cycle.mask_pixels, cycle.masked);
}

template <typename Archive>
void serialize(Archive& archive, CleanReport& report) {
  archive(report.iterations, report.stop, report.stop_reason, report.max_sidelobe, report.cycles, report.kept);
}

template <typename Archive>
void save(Archive& archive, const StageTimes& times) {
  archive(times.stages());
}

template <typename Archive>
void load(Archive& archive, StageTimes& times) {
  std::vector<std::pair<std::string, double>> stages;
  archive(stages);
  times = {};
  for (const auto& [stage, seconds] : stages) times.add(stage, seconds);
}

}  // namespace misfit::imager

namespace misfit::tools {

template <typename Archive>
void serialize(Archive& archive, PixelHistogram& histogram) {
  archive(histogram.noise_jy, histogram.min_jy, histogram.max_jy, histogram.pixels, histogram.beyond_5_sigma,
          histogram.step_sigma, histogram.count);
}

template <typename Archive>
void serialize(Archive& archive, StokesReport& report) {
  archive(report.stokes, report.theory, report.measured, report.clean, report.brightest, report.histogram);
}

template <typename Archive>
void serialize(Archive& archive, BeamChoice& beams) {
  archive(beams.restoring, beams.main_lobe, beams.quadrant, beams.how, beams.misfit, beams.warnings);
}

template <typename Archive>
void serialize(Archive& archive, ChannelReport& report) {
  archive(report.channel, report.frequency_hz, report.stokes, report.measured_predict_rms, report.sums,
          report.predicted_noise_jy, report.beams, report.decisions, report.made_twice);
}

template <typename Archive>
void serialize(Archive& archive, MadeChannel& channel) {
  archive(channel.report, channel.outside_grid, channel.components, channel.major_cycles, channel.warnings, channel.doubts,
          channel.times);
}

template <typename Archive>
void serialize(Archive& archive, ChannelMessage& message) {
  archive(message.kind, message.image_kind, message.at, message.image, message.beam, message.channel);
}

template <typename Archive>
void serialize(Archive& archive, ChannelAnswer& answer) {
  archive(answer.stop, answer.channels);
}

std::string bytes_of(const ChannelMessage& message) {
  return packed(message);
}

ChannelMessage channel_message(std::string bytes) {
  return unpacked<ChannelMessage>(std::move(bytes));
}

std::string bytes_of(const ChannelAnswer& answer) {
  return packed(answer);
}

ChannelAnswer channel_answer(std::string bytes) {
  return unpacked<ChannelAnswer>(std::move(bytes));
}

}  // namespace misfit::tools
