#include <casacore/tables/DataMan/DataManager.h>
#include <casacore/tables/DataMan/TiledStManAccessor.h>

#include <algorithm>
#include <numeric>

#include "ms_io/row_columns_internal.h"

namespace misfit::ms_io {
namespace {

casacore::Vector<casacore::rownr_t> numbered(const std::vector<Run>& runs) {
  std::uint64_t count = 0;
  for (const Run& run : runs) count += run.count;
  casacore::Vector<casacore::rownr_t> numbers(count);
  casacore::rownr_t* out = numbers.data();
  for (const Run& run : runs) {
    std::iota(out, out + run.count, run.first);
    out += run.count;
  }
  return numbers;
}

}  // namespace

Rows::Rows(const std::vector<Run>& runs)
    : contiguous_(runs.size() == 1),
      first_(runs.front().first),
      numbers_(contiguous_ ? casacore::Vector<casacore::rownr_t>() : numbered(runs)),
      count_(contiguous_ ? runs.front().count : numbers_.size()),
      listed_(contiguous_ ? casacore::RefRows(first_, first_ + count_ - 1) : casacore::RefRows(numbers_, false, true)) {}

std::uint64_t Rows::index_of(casacore::rownr_t row) const {
  if (contiguous_) return std::min<std::uint64_t>(row - first_, count_);  // far too many where it is before them
  const casacore::rownr_t *const begin = numbers_.data(), *const end = begin + count_;
  const casacore::rownr_t* const found = std::lower_bound(begin, end, row);
  return found != end && *found == row ? static_cast<std::uint64_t>(found - begin) : count_;
}

casacore::Slicer Rows::range() const {
  return casacore::Slicer(casacore::IPosition(1, static_cast<ssize_t>(first_)),
                          casacore::IPosition(1, static_cast<ssize_t>(count())));
}

CellShapes known_shapes(const casacore::Table& table, const std::string& column) {
  if ((table.tableDesc()[column].options() & casacore::ColumnDesc::FixedShape) != 0) return {true, true};
  if (table.getPartNames(true).size() != 1) return {};
  const casacore::String manager = table.findDataManager(column, true)->dataManagerType();
  if (manager != "TiledShapeStMan" && manager != "TiledDataStMan") return {};
  const casacore::ROTiledStManAccessor tiles(table, column, true);
  const casacore::uInt first = manager == "TiledShapeStMan" ? 1 : 0;  // after a hypercube of cells without shape
  if (tiles.nhypercubes() != first + 1) return {};
  // Every defined cell has a place of its own along the last axis.
  const bool all = table.isRootTable() && static_cast<casacore::rownr_t>(tiles.getHypercubeShape(first).last()) == table.nrow();
  return {true, all};
}

void limit_tile_cache(const casacore::Table& table, const std::string& column) {
  constexpr casacore::uInt most_mib = 64;
  const casacore::Block<casacore::String> parts = table.getPartNames(true);
  if (parts.size() != 1 || !table.isRootTable()) return;
  if (table.findDataManager(column, true)->dataManagerType().substr(0, 5) != "Tiled") return;
  casacore::ROTiledStManAccessor(table, column, true).setMaximumCacheSize(most_mib);
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
