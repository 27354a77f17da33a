#include <algorithm>
#include <limits>

#include "ms_io/block_group_internal.h"
#include "ms_io/spectral_frame_internal.h"

namespace misfit::ms_io {
namespace {

/// A bound on memory: about 12 bytes for a sample of one Stokes parameter.
constexpr std::uint64_t most_samples = std::uint64_t{1} << 23;

/// Runs of more rows than this are read as fast as the whole.
constexpr std::uint64_t long_run = 32;

constexpr std::ptrdiff_t most_blocks = std::numeric_limits<std::uint16_t>::max();

bool scattered(const BlockRows& block) {
  return block.rows < long_run * block.runs.size();
}

/// True if both setups have the same factor between a row's frequencies and frequencies in the frame of the selection.
bool share_frame_ratio(const SelectedRows& selected, const Setup& a, const Setup& b) {
  if (selected.spectral_frame.empty()) return true;
  return a.spectral_frame == b.spectral_frame && (selected.spectral_frame != source_frame || a.field == b.field);
}

/// True if the same slice of the cells is read for both, and their cells have one shape.
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
    const bool joins = end - begin < most_blocks && scattered(*begin) && scattered(*end) && alike(setup, other) &&
                       share_frame_ratio(selected, setup, other) && samples <= most_samples &&
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
  if (group.blocks == 1) {
    group.rows = selected.blocks[first].rows;
    group.runs = selected.blocks[first].runs;
    return group;
  }
  constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();
  std::vector<const Run*> next, end;  // of each block
  std::vector<std::uint64_t> row;     // the first of its next run
  for (std::size_t b = 0; b < group.blocks; ++b) {
    const BlockRows& block = selected.blocks[first + b];
    next.push_back(block.runs.data());
    end.push_back(block.runs.data() + block.runs.size());
    row.push_back(block.runs.front().first);
    group.rows += block.rows;
  }
  group.owner.resize(group.rows);
  for (std::uint16_t* owner = group.owner.data(); owner != group.owner.data() + group.rows;) {
    const auto lowest = static_cast<std::size_t>(std::min_element(row.begin(), row.end()) - row.begin());
    const Run*& run = next[lowest];
    append(group.runs, run->first, run->count);
    owner = std::fill_n(owner, run->count, static_cast<std::uint16_t>(lowest));
    row[lowest] = ++run == end[lowest] ? none : run->first;
  }
  return group;
}

}  // namespace misfit::ms_io
