#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "imager/clean/bright_loops.h"
#include "imager/clean/scales.h"
#include "imager/data/image.h"
#include "imager/numerics/big_array.h"
#include "imager/taylor/taylor_basis.h"

namespace misfit::imager {

/// The response of residuals at one scale to components of another: the spectral PSFs P_k, convolved with the
/// Gaussians of both, in single precision. For points alone these are the whole PSFs; for several scales, their parts near the
/// middle.
class ScaledPsf {
 public:
  /// Takes PSFs P_k [k]; see MinorCycle. NaN counts as 0.
  ScaledPsf(const std::vector<const Image*>& psf, const MultiscaleOptions& options);

  struct Scale {
    LookedAt looked_at;
    TaylorBasis basis;  ///< of the PSFs convolved twice with it
    MeritForm form;     ///< of the merit bias · Rᵀ H⁻¹ R
  };
  /// All scales but those that leave less than 1e-4 of the PSF's peak when it is convolved with them twice: the array does not
  /// see these.
  const std::vector<Scale>& scales() const { return scale_; }
  std::vector<LookedAt> looked_at() const;
  int terms() const { return terms_; }

  /// The number of tiles up to which the PSF is known at least.
  int near_tiles() const { return near_tiles_; }
  bool is_whole() const { return scale_.size() == 1; }

  /// P_k at this distance from the middle, between two scales; 0 up to a tile's side beyond its reach.
  const float* at(std::size_t from, std::size_t to, int k, int row, int column) const {
    return core_[(from * scale_.size() + to) * psfs() + static_cast<std::size_t>(k)] + row * stride_ + column;
  }
  int stride() const { return static_cast<int>(stride_); }  ///< from a row of at() to the next
  /// True if the PSF reaches any pixel of a tile whose first pixel lies so far from a component.
  bool reaches(int row, int column) const;

  /// The strength of the PSF between two scales, in √merit of the other scale, for 1 Jy.
  struct Strength {
    double rms = 0;         ///< anywhere but at its peak
    double rms_beyond = 0;  ///< farther away than near_tiles
    double largest_beyond = 0;
  };
  const Strength& strength(std::size_t from, std::size_t to) const { return strength_[from * scale_.size() + to]; }

 private:
  std::size_t psfs() const { return static_cast<std::size_t>(2 * terms_ - 1); }
  /// Keeps the part of an image that is to be known, about the middle pixel at this place.
  void keep(const Image& psf, int middle_row, int middle_column, int threads);
  const float* middle_of(const BigArray<float>& kept) const;
  Strength strength_of(const float* core) const;

  static constexpr int margin = bright_tile_side;

  int terms_;
  int near_tiles_ = 0;
  std::vector<Scale> scale_;
  int first_row_ = 0, last_row_ = 0;  ///< of what is known, from the middle
  int first_column_ = 0, last_column_ = 0;
  std::ptrdiff_t stride_ = 0;
  std::deque<BigArray<float>> kept_;  ///< [row + margin][column + margin], 0 beyond what is known
  std::vector<const float*> core_;    ///< [from][to][k], their middle
  std::vector<Strength> strength_;    ///< [from][to]
};

}  // namespace misfit::imager
