#pragma once

#include <algorithm>
#include <cstdint>

#include "imager/taylor/taylor_expansion.h"

namespace misfit::imager {

/// Residuals are looked at in squares of so many pixels.
constexpr int bright_tile_side = 64;

/// Spectral PSFs of so many terms.
constexpr int most_spectral_psfs = 2 * most_taylor_terms - 1;

/// Bright places of one tile and scale. Places beyond the last fill up a vector; their values are NaN.
struct BrightRange {
  static constexpr int multiple = 16;

  std::int32_t* offset;             ///< from the tile's first pixel, in pixels of the PSF
  float* value[most_taylor_terms];  ///< residual of each term
  float* merit;                     ///< see MeritForm
  int count;                        ///< a multiple of `multiple`
};

/// A component as a tile sees it.
struct ReachingComponent {
  const float* psf[most_spectral_psfs];  ///< [k] at the tile's first pixel
  float coefficient[most_taylor_terms];  ///< of its spectrum, in Jy
};

/// The merit of residuals R [term] is |F R|², F being a lower triangle: by how much a component there could lower χ².
struct MeritForm {
  float row[most_taylor_terms][most_taylor_terms];
};

/// The merits of `count` places of a row, of residuals [term][column] from column `first` on.
inline void set_merits(const MeritForm& form, int terms, const float* const* row, int first, int count, float* merit) {
  std::fill_n(merit, count, 0.0F);
  for (int a = 0; a < terms; ++a)
    for (int c = 0; c < count; ++c) {
      float y = 0;
      for (int q = 0; q <= a; ++q) y += form.row[a][q] * row[q][first + c];
      merit[c] += y * y;
    }
}

/// Takes components off: R_q −= Σ_t P_{q+t} I_t. Returns the largest merit; −1 where there is none.
float subtract(const ReachingComponent* component, int components, const MeritForm& form, int terms, const BrightRange& range);

}  // namespace misfit::imager
