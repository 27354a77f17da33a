#pragma once

#include <array>
#include <optional>
#include <vector>

#include "imager/data/image.h"
#include "imager/taylor/taylor_expansion.h"

namespace misfit::imager {

/// The algebra of n Taylor terms in one pixel, from the peaks of the spectral PSFs P_k. With the matrix H_qt = P_{q+t}(0) and
/// residuals R_q(p), the coefficients that fit a source there best are the principal solution (Rau & Cornwell 2011, A&A 532,
/// A71),
///
///     I(p) = H⁻¹ R(p),   which takes Rᵀ H⁻¹ R off χ²/Σw.
///
/// With Cholesky's H = L Lᵀ, and residuals in coordinates in which all directions count alike,
///
///     y = √H_00 L⁻¹ R,   |y|² = H_00 Rᵀ H⁻¹ R,   I = L⁻ᵀ y / √H_00,
///
/// |y| corresponds to |R_0| of a single term: for a point source of one term it is the brightness of its peak in Jy/beam, and
/// its square says by how much χ² would fall. L⁻¹ makes of the powers x^t those polynomials that are orthonormal over the
/// samples.
class TaylorBasis {
 public:
  using Matrix = std::array<TaylorValues, most_taylor_terms>;  ///< [row][column]

  /// From peaks P_k(0) [k], 2n − 1 of them. Throws std::invalid_argument for another number of peaks; std::runtime_error where
  /// the samples' frequencies do not tell n terms apart: where the part of x^t orthogonal to lower powers has less than 1e-5 of
  /// its square, which could be the error of PSFs made to 1e-4.
  explicit TaylorBasis(const std::vector<double>& psf_peaks);
  /// The basis of 2n − 1 peaks; none where TaylorBasis() throws.
  static std::optional<TaylorBasis> of(const std::array<double, 2 * most_taylor_terms - 1>& psf_peaks, int terms);

  int terms() const { return terms_; }
  double peak() const { return root_peak_ * root_peak_; }  ///< H_00
  /// y, of residuals R [term].
  TaylorValues coordinates(const TaylorValues& residual) const;
  /// I, of y.
  TaylorValues coefficients(const TaylorValues& y) const;

 private:
  TaylorBasis(int terms, double root_peak, const Matrix& inverse_factor)
      : terms_(terms), root_peak_(root_peak), inverse_factor_(inverse_factor) {}

  int terms_;
  double root_peak_;         ///< √H_00
  Matrix inverse_factor_{};  ///< L⁻¹
};

/// The principal solution of a mosaic, where peaks P_k(0) of sources differ from pixel to pixel: `relative_peaks` are images of
/// P_k(0)/P_0(0) [k − 1], and P_0(0) is 1. Where the samples that see a pixel do not tell the terms apart, the first term is
/// R_0(p) and others are NaN.
std::vector<Image> principal_solution(const std::vector<Image>& relative_peaks, const std::vector<const Image*>& residual,
                                      int threads);

/// The noise of a mosaic's principal solution, for weights 1/σ²: with C = H⁻¹ in each pixel, images of √C_00, of √C_11, and of
/// their correlation C_01/√(C_00 C_11). The first two are in units of the noise of R_0, and divided by `seen`, a primary beam,
/// where R_0 was divided by it. NaN where samples do not tell the terms apart.
struct SolutionNoise {
  Image sigma_0;
  Image sigma_1;
  Image correlation;
};
SolutionNoise solution_noise(const std::vector<Image>& relative_peaks, const Image* seen, int threads);

/// The basis of the PSFs' middle pixels. `psf` [k], 2n − 1 of them.
TaylorBasis basis_of(const std::vector<const Image*>& psf);

/// |y| of each pixel of residual images [term]; NaN where one of these is.
Image brightness(const TaylorBasis& basis, const std::vector<const Image*>& residual, int threads);

/// The principal solution: images of I [term], Jy/beam.
std::vector<Image> principal_solution(const TaylorBasis& basis, const std::vector<const Image*>& residual, int threads);

}  // namespace misfit::imager
