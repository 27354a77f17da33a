#include <algorithm>
#include <limits>

#include "ms_io/row_shares_internal.h"

namespace misfit::ms_io {
namespace {

constexpr std::uint64_t no_row = std::numeric_limits<std::uint64_t>::max();

std::uint64_t rows_below(const BlockRows& block, std::uint64_t row) {
  std::uint64_t rows = 0;
  for (const Run& run : block.runs) {
    if (run.first >= row) break;
    rows += std::min(run.count, row - run.first);
  }
  return rows;
}

std::uint64_t samples_below(const SelectedRows& selected, std::uint64_t row) {
  std::uint64_t samples = 0;
  for (const BlockRows& block : selected.blocks)
    samples += rows_below(block, row) * selected.setups[block.setup].frequency_hz.size();
  return samples;
}

/// The first row below which there are so many samples.
std::uint64_t row_at(const OpenSet& open_set, std::uint64_t samples) {
  std::uint64_t low = 0, high = open_set.set.nrow();
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (samples_below(open_set.selected, middle) < samples)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/// The set with rows [first, end) alone; null where there are none.
std::shared_ptr<const OpenSet> with_rows(const OpenSet& whole, std::uint64_t first, std::uint64_t end) {
  const auto part = std::make_shared<OpenSet>(whole);
  SelectedRows& selected = part->selected;
  selected.blocks.clear();
  selected.rows = selected.samples = 0;
  for (const BlockRows& block : whole.selected.blocks) {
    BlockRows some = rows_between(block, first, end);
    if (some.rows == 0) continue;
    selected.rows += some.rows;
    selected.samples += some.rows * selected.setups[some.setup].frequency_hz.size();
    selected.blocks.push_back(std::move(some));
  }
  return selected.blocks.empty() ? nullptr : part;
}

}  // namespace

BlockRows rows_between(const BlockRows& block, std::uint64_t first, std::uint64_t end) {
  BlockRows part{block.setup, {}, 0};
  for (const Run& run : block.runs) {
    const std::uint64_t from = std::max(run.first, first), to = std::min(run.first + run.count, end);
    if (from >= to) continue;
    part.runs.push_back({from, to - from});
    part.rows += to - from;
  }
  return part;
}

RowShares::RowShares(const OpenSets& sets, int parts) : sets_(sets) {
  constexpr std::uint64_t fiftieth = 50;
  std::uint64_t total = 0;
  for (const auto& set : sets) total += set->selected.samples;
  const auto count = static_cast<std::uint64_t>(parts);
  cuts_.push_back({0, 0});
  for (std::uint64_t part = 1; part < count; ++part) {
    // total · part / count, which may not fit
    const std::uint64_t samples = total / count * part + total % count * part / count;
    cuts_.push_back(cut_at(samples, total / count / fiftieth));
    if (cuts_.back().row != 0) whole_sets_ = false;
  }
  cuts_.push_back({sets.size(), 0});
  for (int index = 0; index < parts; ++index) {
    samples_.push_back(0);
    for (const auto& set : part(index)) samples_.back() += set->selected.samples;
  }
}

RowShares::Cut RowShares::cut_at(std::uint64_t samples, std::uint64_t tolerance) const {
  for (std::size_t s = 0; s < sets_.size(); ++s) {
    const std::uint64_t in_set = sets_[s]->selected.samples;
    if (samples <= tolerance) return {s, 0};
    if (samples + tolerance < in_set) return {s, row_at(*sets_[s], samples)};
    samples -= std::min(samples, in_set);
  }
  return {sets_.size(), 0};
}

OpenSets RowShares::part(int index) const {
  const Cut &begin = cuts_[static_cast<std::size_t>(index)], &end = cuts_[static_cast<std::size_t>(index) + 1];
  OpenSets part;
  for (std::size_t s = begin.set; s < sets_.size() && s <= end.set; ++s) {
    const std::uint64_t first = s == begin.set ? begin.row : 0, last = s == end.set ? end.row : no_row;
    if (auto some = with_rows(*sets_[s], first, last)) part.push_back(std::move(some));
  }
  return part;
}

}  // namespace misfit::ms_io
