#include "imager/streaming/uv_coverage.h"

#include <algorithm>
#include <cmath>

#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

/// Adjacent channels that count as one.
struct ChannelGroup {
  std::size_t first = 0;
  std::size_t end = 0;
  double cells_per_m = 0;  ///< of their middle
};

/// Groups a block's channels by the cells that a sample passes whose highest frequency lies at the square's edge.
std::vector<ChannelGroup> channel_groups(const std::vector<double>& frequency_hz, double reach_lambda) {
  const double highest_hz = *std::max_element(frequency_hz.begin(), frequency_hz.end());
  const auto cell_of = [&](std::size_t c) { return std::floor(frequency_hz[c] / highest_hz * UvCoverage::side / 2); };
  const double cells_per_m_hz = UvCoverage::side / (2 * reach_lambda) / speed_of_light_m_s;
  std::vector<ChannelGroup> groups;
  for (std::size_t first = 0, end = 0; first < frequency_hz.size(); first = end) {
    while (end < frequency_hz.size() && cell_of(end) == cell_of(first)) ++end;
    groups.push_back({first, end, (frequency_hz[first] + frequency_hz[end - 1]) / 2 * cells_per_m_hz});
  }
  return groups;
}

std::uint32_t usable(const float* weight, std::size_t first, std::size_t end) {
  std::uint32_t count = 0;
  for (std::size_t c = first; c < end; ++c) count += weight[c] != 0 ? 1 : 0;
  return count;
}

/// The outermost cells hold samples on the square's border, within rounding.
constexpr double rounding = 1e-6;

bool within(double position) {
  return position >= -rounding && position <= UvCoverage::side + rounding;  // false where it is not finite
}

std::size_t cell(double position) {
  return static_cast<std::size_t>(std::clamp(position, 0.0, UvCoverage::side - 1.0));
}

}  // namespace

UvCoverage::UvCoverage(double reach_lambda)
    : reach_lambda_(reach_lambda), count_(reach_lambda > 0 ? std::size_t{side} * side : 0) {}

void UvCoverage::add(const VisibilityBlock& block) {
  if (count_.empty() || block.samples() == 0) return;
  const std::vector<ChannelGroup> groups = channel_groups(block.frequency_hz, reach_lambda_);
  for (std::size_t row = 0; row < block.rows(); ++row) {
    const float* const weight = &block.weight[row * block.channels()];
    const std::uint32_t of_row = usable(weight, 0, block.channels());
    if (of_row == 0) continue;
    const bool all = of_row == block.channels();
    for (const ChannelGroup& group : groups) {
      const double u = block.uvw_m[3 * row] * group.cells_per_m + side / 2.0;
      const double v = block.uvw_m[3 * row + 1] * group.cells_per_m + side / 2.0;
      if (!within(u) || !within(v)) continue;
      const auto channels = static_cast<std::uint32_t>(group.end - group.first);
      count_[cell(v) * side + cell(u)] += all ? channels : usable(weight, group.first, group.end);
    }
  }
}

void UvCoverage::add_up(const Ranks& ranks) {
  std::vector<double> all(count_.begin(), count_.end());
  ranks.sum(all.data(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) count_[i] = static_cast<std::uint64_t>(all[i]);
}

std::vector<std::uint64_t> UvCoverage::counts() const {
  std::vector<std::uint64_t> both(count_.size());
  for (std::size_t i = 0; i < both.size(); ++i) both[i] = count_[i] + count_[count_.size() - 1 - i];
  return both;
}

}  // namespace misfit::imager
