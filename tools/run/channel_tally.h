#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/run/channel_run.h"

namespace misfit::tools {

/// The sums over the channels of a run, at the rank that puts them together.
class ChannelTally {
 public:
  /// To be called in the order of channels.
  void add(const MadeChannel& channel);

  std::uint64_t samples() const { return samples_; }            ///< of channels, in their images
  std::uint64_t outside_grid() const { return outside_grid_; }  ///< of channels
  /// The samples outside the grid among `taken` samples that the sets have in channels: as large a part as of the channels'
  /// samples, which interpolation makes of them.
  std::uint64_t outside_grid_of(std::uint64_t taken) const;

  /// Throws NothingInGrid, or NothingUsable with these counts, where no channel has samples.
  void require_any(const imager::SampleCounts& counts) const;
  /// The doubts, a sentence each, with their channels where a run has several.
  std::vector<std::string> doubts(bool one) const;
  /// Sentences on the channels of `wanted` that have no values, for want of samples or since the user stopped before.
  std::vector<std::string> missing(int wanted) const;

 private:
  int channels_ = 0;
  int empty_ = 0;
  std::uint64_t samples_ = 0;
  std::uint64_t outside_grid_ = 0;
  std::map<std::string, std::vector<int>> doubts_;  ///< with the channels that have them
};

}  // namespace misfit::tools
