#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/run/channel_run.h"

namespace misfit::tools {

/// What the channels of a run come to, at the rank that puts them together.
class ChannelTally {
 public:
  /// In the order of channels.
  void add(const MadeChannel& channel);

  std::uint64_t samples() const { return samples_; }            ///< of channels, in their images
  std::uint64_t outside_grid() const { return outside_grid_; }  ///< of channels
  /// Of so many samples that the sets have in channels, those outside the grid: as large a part as of the channels' samples,
  /// which interpolation makes of them.
  std::uint64_t outside_grid_of(std::uint64_t taken) const;

  /// Throws NothingInGrid, or NothingUsable with these counts, where no channel has samples.
  void require_any(const imager::SampleCounts& counts) const;
  /// What is doubtful, a sentence each, with the channels of which it is so where a run has several.
  std::vector<std::string> doubts(bool one) const;
  /// Channels of so many that have no values: they have no samples, or the user stopped before.
  std::vector<std::string> missing(int wanted) const;

 private:
  int channels_ = 0;
  int empty_ = 0;
  std::uint64_t samples_ = 0;
  std::uint64_t outside_grid_ = 0;
  std::map<std::string, std::vector<int>> doubts_;  ///< with the channels of which they are
};

}  // namespace misfit::tools
