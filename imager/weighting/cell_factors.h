#pragma once

#include "imager/weighting/cell_values.h"

namespace misfit::imager {

/// The factors of samples' weights by cells of a density; 0 in cells without samples. Densities and factors are both held in
/// `Cells`, DenseCells or CellTiles, which give the same bits.

/// 1/W_k, or 1/(Σ W over the cells within `reach` columns and rows of k): uniform, and superuniform weights. The whole plane
/// counts, across v = 0 too.
template <template <typename> class Cells>
Cells<float> uniform_factors(const Cells<double>& weight, int reach = 0);

/// Briggs's f² = (5 · 10^−R)² / (Σ_k W_k² / Σ_i w_i). Both sums run over samples and conjugates, as CASA's do; over half the
/// plane both halve, and f² is the same. 0 without samples. Briggs 1995, High fidelity deconvolution of moderately resolved
/// sources (thesis, New Mexico Tech), section 3.
template <template <typename> class Cells>
double briggs_f2(const Cells<double>& weight, double robust);

/// 1/(4 W_k R² + 2 σ²): of CASA's briggsabs, whose weights are four times ours.
template <template <typename> class Cells>
Cells<float> briggs_abs_factors(const Cells<double>& weight, double robust, double noise_jy);

/// 1/(1 + W_k f²).
template <template <typename> class Cells>
Cells<float> briggs_factors(const Cells<double>& weight, double f2);

/// Limits how far factors rise above those about them: WSClean's rank filter, which keeps sparse cells from outweighing others.
struct RankFilter {
  double level = 3;  ///< above 0
  int reach = 8;     ///< columns and rows on either side
};

/// min(F_k, level × mean F), the mean over the cells with samples within `reach` columns and rows of k, k among them. The whole
/// plane counts, across v = 0 too.
template <template <typename> class Cells>
Cells<float> rank_filtered(const Cells<float>& factor, const RankFilter& filter);

}  // namespace misfit::imager
