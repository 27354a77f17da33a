#pragma once

#include <vector>

#include "imager/data/visibilities.h"
#include "imager/weighting/uv_cells.h"

namespace misfit::imager {

/// How much weight lies in each cell of the uv plane: W_k = Σ w of the samples in cell k and of the conjugates of others that
/// lie there. Samples beyond 1/(2 cell), which imaging leaves out, do not count. Each cell is summed in double precision in the
/// order of its samples: the same bits for any number of threads, and for blocks of any number of rows.
class UvDensity {
 public:
  UvDensity(const ImageGeometry& geometry, int threads);

  void add(const VisibilityBlock& block);
  /// Becomes that of all ranks.
  void add_up(const Ranks& ranks) { ranks.sum(weight_.data(), weight_.size()); }

  const UvCells& cells() const { return cells_; }
  /// W_k of the half plane that UvCells describes, row-major [v][u].
  const std::vector<double>& weights() const { return weight_; }

 private:
  /// Adjacent channels of a row that lie in one cell.
  struct Run {
    std::uint32_t cell = 0;
    double weight = 0;
  };
  /// The runs of some rows, by bands of cells, in the order of their samples within each.
  struct Piece {
    std::vector<std::uint32_t> cell;  ///< of a row's channels
    std::vector<Run> found;
    std::vector<Run> sorted;
    std::vector<std::size_t> band_begin;
  };

  void find_runs(const VisibilityBlock& block, const std::vector<double>& turns_per_m, std::size_t first_row,
                 std::size_t end_row, Piece& piece) const;
  void sort_by_band(Piece& piece) const;

  UvCells cells_;
  int threads_;
  int band_shift_ = 0;  ///< a band holds 2 to this power of cells
  std::size_t bands_ = 0;
  std::vector<double> weight_;
  std::vector<Piece> pieces_;
};

}  // namespace misfit::imager
