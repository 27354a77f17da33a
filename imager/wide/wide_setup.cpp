#include "imager/wide/wide_setup.h"

#include <limits>

namespace misfit::imager {

// A prediction holds its visibilities and, at worst, a run for each sample, twice while runs are sorted. An adjoint takes less
// for the first Stokes parameter, and w V for each of the others.
static_assert(wide_bytes_a_sample == sizeof(std::complex<double>) + 2 * sizeof(StackRun) + 8);
static_assert(wide_bytes_a_value == sizeof(std::complex<double>));

StackShape stack_shape_of(const WideTransformOptions& o) {
  constexpr int tile = 32;
  return {o.nu, o.nv, o.kernel_u.width(), std::max(tile, o.kernel_u.width())};
}

namespace {

/// Bytes of a row of a pair, and of the columns that the image keeps of a whole pair.
struct PairBytes {
  double stored_row;
  double kept;

  PairBytes(const WideTransformOptions& o, int grids) {
    const bool single = o.precision == Precision::single_precision;
    const double cell = 2.0 * grids * (single ? sizeof(std::complex<float>) : sizeof(std::complex<double>));
    stored_row = cell * stack_shape_of(o).columns();
    kept = cell * (o.nv / 2 + 1) * (largest_facet(o.geometry.width, o.facets_l) + columns_at_once - 1);
  }
};

}  // namespace

int most_pairs(const WideTransformOptions& o, int grids) {
  const PairBytes pair(o, grids);
  const double bytes = pair.kept + pair.stored_row * stack_shape_of(o).held_rows(1);
  return std::max(1, static_cast<int>(static_cast<double>(o.stack_bytes) / bytes));
}

int tiles_a_band(const WideTransformOptions& o, int pairs, int grids) {
  constexpr double cache = 12 << 20;
  const double tile_row = pairs * PairBytes(o, grids).stored_row * stack_shape_of(o).tile;
  return static_cast<int>(std::clamp(std::min(cache, static_cast<double>(o.stack_bytes)) / tile_row, 1.0, 16.0));
}

double bytes_of_pairs(const WideTransformOptions& o, int pairs, int grids) {
  const PairBytes pair(o, grids);
  return pairs * (pair.kept + pair.stored_row * stack_shape_of(o).held_rows(tiles_a_band(o, pairs, grids)));
}

template <typename Real>
WideSetup<Real> wide_setup(const WideTransformOptions& o) {
  WideSetup<Real> s{o,
                    stack_shape_of(o),
                    {TapTable<Real>(o.kernel_u.polynomial, o.lookup), TapTable<Real>(o.kernel_v.polynomial, o.lookup),
                     TapTable<Real>(o.kernel_w.polynomial, o.lookup)},
                    {}};
  const SmoothCorrection h_w(o.kernel_w, std::numeric_limits<Real>::epsilon() / 8);
  for (const Facet& facet : split_into_facets(o.geometry, o.facets_l, o.facets_m)) {
    if (facet.empty) continue;
    constexpr double flat = 1e-15;  // a facet of one pixel has no curvature
    s.facets.push_back({facet, o.kernel_w.x0 / std::max(facet.reach, flat),
                        axis_correction(o.kernel_u, facet.geometry.width, o.nu),
                        axis_correction(o.kernel_v, facet.geometry.height, o.nv), h_w});
  }
  return s;
}

template WideSetup<float> wide_setup<float>(const WideTransformOptions&);
template WideSetup<double> wide_setup<double>(const WideTransformOptions&);

bool is_sparse(const StackOrder& order, const StackTask& task) {
  constexpr std::size_t most_in_place = 512;  // measured: from some 800 on, a buffer's nearness to the processor wins
  if (task.end - task.begin > most_in_place) return false;
  std::size_t samples = 0;
  for (std::size_t r = task.begin; r < task.end; ++r) samples += order.run[r].count;
  return samples <= most_in_place;
}

}  // namespace misfit::imager
