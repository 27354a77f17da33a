#include "tools/run/channel_tally.h"

#include <cmath>

#include "tools/base/numbers.h"

namespace misfit::tools {

void ChannelTally::add(const MadeChannel& channel) {
  ++channels_;
  empty_ += channel.empty() ? 1 : 0;
  samples_ += channel.report.sums.used;
  outside_grid_ += channel.outside_grid;
  for (const std::string& doubt : channel.doubts) doubts_[doubt].push_back(channel.report.channel);
}

std::uint64_t ChannelTally::outside_grid_of(std::uint64_t taken) const {
  if (outside_grid_ == 0) return 0;
  const double part = static_cast<double>(outside_grid_) / static_cast<double>(outside_grid_ + samples_);
  return static_cast<std::uint64_t>(std::ceil(static_cast<double>(taken) * part));
}

void ChannelTally::require_any(const imager::SampleCounts& counts) const {
  if (channels_ > empty_) return;
  if (outside_grid_ > 0) throw imager::NothingInGrid(outside_grid_);
  throw imager::NothingUsable(counts);
}

std::vector<std::string> ChannelTally::doubts(bool one) const {
  std::vector<std::string> sentences;
  for (const auto& [doubt, numbers] : doubts_)
    sentences.push_back((one ? "" : std::string("plane") + (numbers.size() > 1 ? "s " : " ") + in_runs(numbers) + ": ") +
                        doubt);
  return sentences;
}

std::vector<std::string> ChannelTally::missing(int wanted) const {
  std::vector<std::string> sentences;
  const std::string of_all = " of " + std::to_string(wanted) + " planes have no ";
  if (empty_ > 0) sentences.push_back(std::to_string(empty_) + of_all + "samples: they have no values and no beam");
  if (const int left = wanted - channels_; left > 0)
    sentences.push_back("stopped by the user: " + std::to_string(left) + of_all + "values");
  return sentences;
}

}  // namespace misfit::tools
