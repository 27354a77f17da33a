#include "imager/streaming/weight_shares.h"

#include <map>
#include <utility>

#include "imager/transform/sampling.h"

namespace misfit::imager {
namespace {

/// [kind], for the rows of a block, a sum for every channel.
using ChannelSums = std::map<std::uint32_t, std::vector<double>>;

ChannelSums sums_of(const VisibilityBlock& block, std::uint64_t first_row, const ShareOptions& options) {
  SampleSums uncounted;
  ImageGeometry image;
  image.cell_rad = options.cell_rad;
  const std::vector<float> weight = imaging_weights(block, {image, false, options.threads}, uncounted);
  const std::size_t channels = block.channels();
  ChannelSums sums;
  for (std::size_t row = 0; row < block.rows(); ++row) {
    std::vector<double>& sum = sums[options.kind_of ? options.kind_of(first_row + row) : 0];
    sum.resize(channels);
    for (std::size_t channel = 0; channel < channels; ++channel) sum[channel] += weight[row * channels + channel];
  }
  return sums;
}

/// Σ w, [kind and frequency].
using ByKind = std::map<std::pair<std::uint32_t, double>, double>;

std::vector<WeightShare> listed(const ByKind& weight) {
  std::vector<WeightShare> shares;
  for (const auto& [key, sum] : weight) shares.push_back({key.first, key.second, sum});
  return shares;
}

}  // namespace

std::vector<WeightShare> weight_shares(const VisibilitySource& source, const ShareOptions& options) {
  ByKind weight;
  std::uint64_t first_row = 0;
  const auto stream = source.open();
  while (const auto block = stream->next()) {
    for (const auto& [kind, sums] : sums_of(*block, first_row, options))
      for (std::size_t channel = 0; channel < sums.size(); ++channel)
        if (sums[channel] > 0) weight[{kind, block->frequency_hz[channel]}] += sums[channel];
    first_row += block->rows();
  }
  if (source.ranks().alone()) return listed(weight);
  ByKind of_all;
  for (const WeightShare& s : join_at_first(source.ranks(), listed(weight))) of_all[{s.kind, s.frequency_hz}] += s.weight;
  return listed(of_all);
}

}  // namespace misfit::imager
