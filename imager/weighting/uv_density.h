#pragma once

#include <optional>
#include <vector>

#include "imager/data/visibilities.h"
#include "imager/weighting/cell_values.h"

namespace misfit::imager {

/// Throws std::invalid_argument where there are several pointings, and the coordinates' sights do not tell each row's pointing.
void require_pointings(const SampleCoordinates& coordinates, std::size_t pointings);

/// How much weight lies in each cell of the uv plane: W_k = Σ w of the samples in cell k and of other samples whose conjugates
/// lie there. Samples beyond 1/(2 cell), which imaging leaves out, do not count. Each cell is summed in double precision in the
/// order of its samples: the same bits for any number of threads, and for blocks of any number of rows.
///
/// Each of several pointings has a density of its own, of which only tiles that samples touch are held: it has the same bits as
/// the density of its samples alone.
class UvDensity {
 public:
  UvDensity(const ImageGeometry& geometry, int threads, std::size_t pointings = 1);

  /// Where there are several pointings, the block's sights must tell its rows' pointings: throws std::invalid_argument where
  /// they do not.
  void add(const VisibilityBlock& block);
  /// Adds the densities of all other ranks.
  void add_up(const Ranks& ranks);

  const UvCells& cells() const { return cells_; }
  int threads() const { return threads_; }
  /// W_k of the half plane that UvCells describes, where all samples share one density.
  const DenseCells<double>& weights() const { return weight_.value(); }
  /// W_k of each of several pointings; empty where all samples share one density.
  const std::vector<CellTiles<double>>& weights_of_pointings() const { return weight_of_pointing_; }

 private:
  bool shared() const { return weight_.has_value(); }

  /// Adjacent channels of a row that lie in one cell.
  struct Run {
    std::uint32_t cell = 0;  ///< its place in tiles where pointings have their own densities
    std::uint32_t pointing = 0;
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
  void add_runs(const Run* run, const Run* end);

  UvCells cells_;
  int threads_;
  int band_shift_ = 0;  ///< a band holds 2 to this power of cells
  std::size_t bands_ = 0;
  std::optional<DenseCells<double>> weight_;           ///< shared by all samples
  std::vector<CellTiles<double>> weight_of_pointing_;  ///< where pointings have their own
  std::vector<Piece> pieces_;
};

}  // namespace misfit::imager
