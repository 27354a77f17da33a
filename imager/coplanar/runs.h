#pragma once

#include <algorithm>

#include "imager/numerics/parallel.h"

namespace misfit::imager {

/// Rows or columns that a thread deals with at a time: some lines of the cache of each while columns are brought to contiguous
/// memory.
inline constexpr int run_at_once = 16;

/// Calls visit(first, at, count) for the runs of [begin, end) that lie side by side in a period of n: `count` numbers from
/// `first` on, at places from at = first mod n on.
template <typename Visit>
void for_runs(int begin, int end, int n, const Visit& visit) {
  for (int first = begin; first < end;) {
    const int at = (first % n + n) % n;
    const int count = std::min(end - first, n - at);
    visit(first, at, count);
    first += count;
  }
}

/// Calls body(begin, end) for consecutive pieces of [0, count), shared among threads.
template <typename Body>
void in_pieces(int count, int threads, const Body& body) {
  const std::size_t pieces = static_cast<std::size_t>((count + run_at_once - 1) / run_at_once);
  parallel_for(pieces, threads, [&](std::size_t piece) {
    const int begin = static_cast<int>(piece) * run_at_once;
    body(begin, std::min(begin + run_at_once, count));
  });
}

}  // namespace misfit::imager
