#include <algorithm>

#include "ms_io/block_group_internal.h"

namespace misfit::ms_io {
namespace {

/// A bound on memory: about 12 bytes for a sample of one Stokes parameter.
constexpr std::uint64_t most_samples = std::uint64_t{1} << 23;

/// Runs of more rows than this are read as fast as the whole.
constexpr std::uint64_t long_run = 32;

bool scattered(const BlockRows& block) {
  return block.rows < long_run * block.runs.size();
}

/// Whether the same slice of the cells of both is read, and the cells have one shape.
bool alike(const Setup& a, const Setup& b) {
  return a.correlation_types.size() == b.correlation_types.size() && a.stored_channels == b.stored_channels &&
         a.first_channel() == b.first_channel() && a.last_channel() == b.last_channel();
}

/// The end of the group that begins with the block `first`. Blocks of one setup never alternate.
std::size_t end_of_group(const SelectedRows& selected, std::size_t first) {
  const auto begin = selected.blocks.begin() + static_cast<std::ptrdiff_t>(first);
  const Setup& setup = selected.setups[begin->setup];
  std::uint64_t samples = 0;
  auto end = begin;
  while (end != selected.blocks.end()) {
    const Setup& other = selected.setups[end->setup];
    samples += end->rows * other.frequency_hz.size();
    const bool joins = scattered(*begin) && scattered(*end) && alike(setup, other) && samples <= most_samples &&
                       std::none_of(begin, end, [&](const BlockRows& block) { return block.setup == end->setup; });
    if (end != begin && !joins) break;
    ++end;
  }
  return static_cast<std::size_t>(end - selected.blocks.begin());
}

}  // namespace

BlockGroup block_group(const SelectedRows& selected, std::size_t first) {
  BlockGroup group;
  group.blocks = end_of_group(selected, first) - first;
  std::vector<std::size_t> next(group.blocks, 0);  // run of each
  while (true) {
    const Run* lowest = nullptr;
    std::size_t of = 0;
    for (std::size_t b = 0; b < group.blocks; ++b) {
      const std::vector<Run>& runs = selected.blocks[first + b].runs;
      if (next[b] == runs.size() || (lowest != nullptr && lowest->first < runs[next[b]].first)) continue;
      lowest = &runs[next[b]];
      of = b;
    }
    if (lowest == nullptr) return group;
    ++next[of];
    append(group.runs, lowest->first, lowest->count);
    if (group.shares.empty() || group.shares.back().block != of) group.shares.push_back({of, 0});
    group.shares.back().rows += lowest->count;
  }
}

}  // namespace misfit::ms_io
