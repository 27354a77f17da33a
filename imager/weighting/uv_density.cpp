#include "imager/weighting/uv_density.h"

#include <algorithm>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

/// So many that threads share them evenly, and few enough that a piece has some runs for each.
constexpr std::size_t most_bands = 128;
constexpr int smallest_band_shift = 10;
constexpr std::size_t samples_a_piece = 32768;

}  // namespace

UvDensity::UvDensity(const ImageGeometry& geometry, int threads)
    : cells_(geometry), threads_(threads), band_shift_(smallest_band_shift), weight_(cells_.count()) {
  while ((cells_.count() >> band_shift_) >= most_bands) ++band_shift_;
  bands_ = (cells_.count() >> band_shift_) + 1;
}

/// Pieces are looked at by any thread, and then each band by one, which takes the pieces in their order.
void UvDensity::add(const VisibilityBlock& block) {
  if (block.samples() == 0) return;
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
      const Piece& piece = pieces_[p];
      for (std::size_t i = piece.band_begin[band]; i < piece.band_begin[band + 1]; ++i)
        weight_[piece.sorted[i].cell] += piece.sorted[i].weight;
    }
  });
}

void UvDensity::find_runs(const VisibilityBlock& block, const std::vector<double>& turns_per_m, std::size_t first_row,
                          std::size_t end_row, Piece& piece) const {
  const std::size_t channels = block.channels();
  piece.cell.resize(channels);
  piece.found.clear();
  for (std::size_t row = first_row; row < end_row; ++row) {
    cells_.of_row(&block.uvw_m[3 * row], turns_per_m, piece.cell.data());
    const float* const weight = &block.weight[row * channels];
    for (std::size_t c = 0; c < channels;) {
      Run run{piece.cell[c], 0};
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
