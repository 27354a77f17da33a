#include <algorithm>

#include "ms_io/row_columns_internal.h"

namespace misfit::ms_io {
namespace {

casacore::Vector<casacore::rownr_t> numbered(const std::vector<Run>& runs) {
  std::vector<casacore::rownr_t> numbers;
  for (const Run& run : runs) {
    for (std::uint64_t i = 0; i < run.count; ++i) numbers.push_back(run.first + i);
  }
  return casacore::Vector<casacore::rownr_t>(numbers);
}

}  // namespace

Rows::Rows(const std::vector<Run>& runs)
    : contiguous_(runs.size() == 1),
      first_(runs.front().first),
      count_(0),
      numbers_(numbered(runs)),
      listed_(numbers_, false, true) {
  for (const Run& run : runs) count_ += run.count;
}

casacore::Slicer Rows::range() const {
  return casacore::Slicer(casacore::IPosition(1, static_cast<ssize_t>(first_)),
                          casacore::IPosition(1, static_cast<ssize_t>(count_)));
}

std::vector<Rows> pieces(const std::vector<Run>& runs, std::uint64_t rows) {
  std::vector<Rows> result;
  std::vector<Run> piece;
  std::uint64_t free = rows;
  for (Run run : runs) {
    while (run.count > 0) {
      const std::uint64_t taken = std::min(run.count, free);
      piece.push_back({run.first, taken});
      run.first += taken;
      run.count -= taken;
      free -= taken;
      if (free > 0) continue;
      result.emplace_back(piece);
      piece.clear();
      free = rows;
    }
  }
  if (!piece.empty()) result.emplace_back(piece);
  return result;
}

casacore::Slicer channel_slice(const Setup& setup, std::size_t correlations) {
  return casacore::Slicer(
      casacore::IPosition(2, 0, static_cast<ssize_t>(setup.first_channel())),
      casacore::IPosition(2, static_cast<ssize_t>(correlations), static_cast<ssize_t>(setup.channel_span())));
}

}  // namespace misfit::ms_io
