#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include "imager/data/extent.h"
#include "imager/data/stored_visibilities.h"
#include "imager/transform/imaging.h"
#include "imager/weighting/cell_factors.h"
#include "imager/weighting/uv_density.h"
#include "imager/weighting/uv_taper.h"
#include "imager/weighting/uv_window.h"

namespace misfit::imager {

enum class Weighting { natural, uniform, superuniform, briggs, briggs_abs, briggs_bandwidth_taper };

/// How the weights of an image follow from the data's weights w. With W_k, the density of the sample's cell (see UvDensity):
///   natural       w
///   uniform       w / W_k
///   superuniform  w / Σ W, over the cells within `box_reach` of it
///   briggs        w / (1 + W_k f²), see briggs_f2
///   briggs_abs    w / (W_k R² + 2 σ²), where weights are 1/σ² as CASA has them: four times ours
///   briggs_bandwidth_taper   w / (1 + W_k f²/m), with r = Δν/ν_c √(u² + v²) in cells, m = r + ½ where r ≥ 1, and below
///                 m = (4 − r)/(4 − 2r): weights of a cube's plane as those of its whole band would be
/// each times the factors of the taper and the window. The density counts every sample as if there were no taper and no window,
/// as CASA's and WSClean's does. Each of several pointings has its own density and f², as with CASA's `mosweight`. A rank
/// filter cuts the factors of cells before taper and window act. The documentation of CASA's tclean has these equations, but
/// for natural and uniform.
struct WeightingOptions {
  Weighting weighting = Weighting::natural;
  double robust = 0.5;                      ///< R of briggs: −2, nearly uniform, to 2, nearly natural
  double noise_jy = 1;                      ///< σ of briggs_abs
  double fractional_bandwidth = 0;          ///< Δν/ν_c of briggs_bandwidth_taper: of the whole cube
  int box_reach = 3;                        ///< superuniform: columns and rows on either side
  std::optional<RankFilter> rank_filter{};  ///< not of natural, nor of briggs_bandwidth_taper, whose factors vary in a cell
  std::optional<UvTaper> taper{};
  UvWindow window{};
  /// If more than 1, each pointing has a density of its own, and the sights of a block tell its rows' pointings; 1: all samples
  /// share one density.
  std::size_t pointings = 1;

  bool needs_density() const { return weighting != Weighting::natural; }
  /// True if the data's weights stay as they are.
  bool none() const { return !needs_density() && !tapers(); }
  /// True if weights depend on where in the uv plane a sample lies, besides its cell.
  bool tapers() const { return taper || !window.is_whole_plane(); }
};

/// Sums over samples within 1/(2 cell): w are the data's weights, w' the image's.
struct WeightSums {
  double natural = 0;              ///< Σ w
  double image = 0;                ///< Σ w'
  double square_over_natural = 0;  ///< Σ w'²/w

  /// The sums of data that are imaged with their own weights.
  static WeightSums of_natural(double weight) { return {weight, weight, weight}; }
  WeightSums& operator+=(const WeightSums& other);

  /// True if the least weights that `samples` have, see ImagingWeights::of(), add up to a millionth of the image at most.
  bool outweigh_least(std::uint64_t samples) const;
  /// The standard deviation of an image's noise in Jy/beam, where w is 1/(4 σ²) of the data's noise in Jy (see
  /// VisibilityBlock::weight): √(Σ w'²/(4w)) / Σ w'. It is as right as the data's weights.
  double noise_jy() const;
  /// The least that any weights give: 1/(2 √Σ w).
  double natural_noise_jy() const;
};

/// Sums over the weights of an image.
struct WeightTotals {
  WeightSums sums;
  WSpread w_spread;

  WeightTotals& operator+=(const WeightTotals& other);
  /// Adds the totals of all other ranks.
  void add_up(const Ranks& ranks);
};

/// A block with its weights for the image.
struct WeightedBlock {
  std::shared_ptr<const VisibilityBlock> block;
  WeightTotals totals;
};

/// f² of several pointings with samples.
struct F2Range {
  double least = 0;
  double largest = 0;
};

/// The weights of an image.
class ImagingWeights {
 public:
  /// Natural weights, with the taper and the window of `options`.
  ImagingWeights(const ImageGeometry& geometry, const WeightingOptions& options);
  /// Weights by density; `options.weighting` is not natural.
  ImagingWeights(const UvDensity& density, const WeightingOptions& options);

  /// `block`, with its other Stokes parameters and the weights of the image: the same block where nobody else holds it, else a
  /// copy. Usable samples stay usable: those beyond 1/(2 cell), outside the window or tapered to nothing keep the smallest
  /// weight that there is. Throws std::invalid_argument where there are several pointings, and the block's sights do not tell
  /// those of its rows.
  WeightedBlock of(std::shared_ptr<const VisibilityBlock> block) const;
  /// Puts the weights on all blocks.
  WeightTotals put_on(StoredVisibilities& visibilities, int threads) const;

  const F2Range& f2() const { return f2_; }  ///< of Briggs weights that have it, else 0
  /// Cells with samples in half the plane, added up over pointings that have their own density; 0 without a density.
  std::uint64_t cells_filled() const { return filled_; }
  /// Pointings that have a density of their own; 1 where all samples share one, or there is none.
  std::size_t pointings() const { return std::max<std::size_t>(1, factor_of_pointing_.size()); }
  const UvCells& cells() const { return cells_; }

 private:
  void factors_from(const std::vector<CellTiles<double>>& density_of_pointings, const WeightingOptions& options, int threads);
  void weigh(VisibilityBlock& block, WeightSums& sums) const;

  UvCells cells_;
  std::optional<UvTaper> taper_;
  UvWindow window_;
  F2Range f2_;
  double fractional_bandwidth_ = 0;  ///< not 0: factors depend on where in the plane a sample lies, too
  std::uint64_t filled_ = 0;
  std::optional<DenseCells<float>> factor_;           ///< shared by all samples; none: 1
  std::vector<CellTiles<float>> factor_of_pointing_;  ///< where there are several
};

/// The weights that `options` ask for, after a pass over `source` where they follow from its density; null where they are the
/// data's own. Stages timed: "read", "weights".
std::shared_ptr<const ImagingWeights> make_imaging_weights(const VisibilitySource& source, const WeightingOptions& options,
                                                           const ImageGeometry& geometry, const Context& context);

}  // namespace misfit::imager
