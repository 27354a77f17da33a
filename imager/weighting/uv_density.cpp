#include "imager/weighting/uv_density.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

/// The most bands: enough that threads share them evenly, and so few that a piece has some runs for each.
constexpr std::size_t most_bands = 128;
constexpr int smallest_band_shift = 10;
constexpr std::size_t samples_a_piece = 32768;

/// Adds the tiles of all other ranks; all ranks then have touched the same tiles.
void add_up_tiles(const Ranks& ranks, CellTiles<double>& weight) {
  std::vector<double> touched(weight.cells().tiles());
  for (std::size_t t = 0; t < touched.size(); ++t) touched[t] = weight.tile(t) != nullptr ? 1 : 0;
  ranks.largest(touched.data(), touched.size());
  std::vector<double> all;
  for (std::size_t t = 0; t < touched.size(); ++t)
    if (touched[t] > 0) all.insert(all.end(), weight.touch_tile(t).begin(), weight.touch_tile(t).end());
  ranks.sum(all.data(), all.size());
  auto next = all.begin();
  for (std::size_t t = 0; t < touched.size(); ++t) {
    if (touched[t] == 0) continue;
    std::copy_n(next, UvCells::tile_cells, weight.touch_tile(t).begin());
    next += UvCells::tile_cells;
  }
}

}  // namespace

void require_pointings(const SampleCoordinates& coordinates, std::size_t pointings) {
  if (pointings <= 1) return;
  if (coordinates.sights.size() != coordinates.rows())
    throw std::invalid_argument(std::to_string(coordinates.sights.size()) + " sights of " + std::to_string(coordinates.rows()) +
                                " rows; expected one for each, that tells its pointing");
  for (const RowSight& sight : coordinates.sights)
    if (sight.field < 0 || static_cast<std::size_t>(sight.field) >= pointings)
      throw std::invalid_argument("a row of pointing " + std::to_string(sight.field) + "; expected one from 0 to " +
                                  std::to_string(pointings - 1));
}

/// A tile lies within one band.
UvDensity::UvDensity(const ImageGeometry& geometry, int threads, std::size_t pointings)
    : cells_(geometry), threads_(threads), band_shift_(smallest_band_shift) {
  if (pointings <= 1) weight_.emplace(cells_);
  for (std::size_t p = 0; !shared() && p < pointings; ++p) weight_of_pointing_.emplace_back(cells_);
  const std::size_t places = shared() ? cells_.count() : cells_.tiles() * UvCells::tile_cells;
  while ((places >> band_shift_) >= most_bands) ++band_shift_;
  bands_ = (places >> band_shift_) + 1;
}

void UvDensity::add_up(const Ranks& ranks) {
  if (ranks.alone()) return;
  if (shared()) ranks.sum(weight_->data(), weight_->size());
  for (CellTiles<double>& weight : weight_of_pointing_) add_up_tiles(ranks, weight);
}

/// Pieces are looked at by any thread, and then each band by one, which takes the pieces in their order.
void UvDensity::add(const VisibilityBlock& block) {
  if (block.samples() == 0) return;
  if (!shared()) require_pointings(block, weight_of_pointing_.size());
  const std::vector<double> turns = cells_.turns_per_m(block.frequency_hz);
  const std::size_t rows_a_piece = std::max<std::size_t>(1, samples_a_piece / block.channels());
  const std::size_t pieces = (block.rows() + rows_a_piece - 1) / rows_a_piece;
  if (pieces_.size() < pieces) pieces_.resize(pieces);
  parallel_for(pieces, threads_, [&](std::size_t p) {
    find_runs(block, turns, p * rows_a_piece, std::min((p + 1) * rows_a_piece, block.rows()), pieces_[p]);
    sort_by_band(pieces_[p]);
  });
  parallel_for(bands_, threads_, [&](std::size_t band) {
    for (std::size_t p = 0; p < pieces; ++p) {
      const Run* const runs = pieces_[p].sorted.data();
      add_runs(runs + pieces_[p].band_begin[band], runs + pieces_[p].band_begin[band + 1]);
    }
  });
}

void UvDensity::add_runs(const Run* run, const Run* end) {
  if (shared())
    for (double* const weight = weight_->data(); run != end; ++run) weight[run->cell] += run->weight;
  else
    for (; run != end; ++run) weight_of_pointing_[run->pointing].touch(run->cell) += run->weight;
}

void UvDensity::find_runs(const VisibilityBlock& block, const std::vector<double>& turns_per_m, std::size_t first_row,
                          std::size_t end_row, Piece& piece) const {
  const std::size_t channels = block.channels();
  piece.cell.resize(channels);
  piece.found.clear();
  for (std::size_t row = first_row; row < end_row; ++row) {
    if (shared())
      cells_.of_row(&block.uvw_m[3 * row], turns_per_m, piece.cell.data());
    else
      cells_.places_of_row(&block.uvw_m[3 * row], turns_per_m, piece.cell.data());
    const std::uint32_t pointing = shared() ? 0 : static_cast<std::uint32_t>(block.sights[row].field);
    const float* const weight = &block.weight[row * channels];
    for (std::size_t c = 0; c < channels;) {
      Run run{piece.cell[c], pointing, 0};
      for (; c < channels && piece.cell[c] == run.cell; ++c) run.weight += double{weight[c]};
      if (run.cell != UvCells::outside && run.weight > 0) piece.found.push_back(run);
    }
  }
}

void UvDensity::sort_by_band(Piece& piece) const {
  piece.band_begin.assign(bands_ + 1, 0);
  for (const Run& run : piece.found) ++piece.band_begin[(run.cell >> band_shift_) + 1];
  for (std::size_t band = 0; band < bands_; ++band) piece.band_begin[band + 1] += piece.band_begin[band];
  piece.sorted.resize(piece.found.size());
  std::vector<std::size_t> next(piece.band_begin.begin(), piece.band_begin.end() - 1);
  for (const Run& run : piece.found) piece.sorted[next[run.cell >> band_shift_]++] = run;
}

}  // namespace misfit::imager
