#pragma once

#include <array>
#include <optional>
#include <vector>

#include "imager/data/image.h"
#include "imager/taylor/taylor_expansion.h"

namespace misfit::imager {

/// What the spectral PSFs P_k of n Taylor terms make of one pixel. With their peaks the matrix H_qt = P_{q+t}(0), and residuals
/// R_q(p), the coefficients that fit a source there best are those of the principal solution (Rau & Cornwell 2011, A&A 532,
/// A71),
///
///     I(p) = H⁻¹ R(p),   which takes Rᵀ H⁻¹ R off χ²/Σw.
///
/// With Cholesky's H = L Lᵀ, and residuals in coordinates in which all directions count alike,
///
///     y = √H_00 L⁻¹ R,   |y|² = H_00 Rᵀ H⁻¹ R,   I = L⁻ᵀ y / √H_00,
///
/// |y| is what |R_0| is to a single term: of a point source of one term it is the brightness of its peak in Jy/beam, and its
/// square says by how much χ² would fall. L⁻¹ makes of the powers x^t those polynomials that are orthonormal over the samples.
class TaylorBasis {
 public:
  using Matrix = std::array<TaylorValues, most_taylor_terms>;  ///< [row][column]

  /// Of peaks P_k(0) [k], 2n − 1 of them. Throws std::invalid_argument where their number is none of these;
  /// std::runtime_error where the samples' frequencies do not tell n terms apart: where what of x^t is orthogonal to lower
  /// powers is less than 1e-5 of its square, which the error of PSFs made to 1e-4 could be.
  explicit TaylorBasis(const std::vector<double>& psf_peaks);
  /// Of 2n − 1 peaks; none where TaylorBasis() throws.
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

/// The same of a mosaic, where peaks P_k(0) of sources differ from pixel to pixel: `relative_peaks` are images of P_k(0)/P_0(0)
/// [k − 1], and P_0(0) is 1. Where the samples that see a pixel do not tell the terms apart, the first is R_0(p) and others are
/// NaN.
std::vector<Image> principal_solution(const std::vector<Image>& relative_peaks, const std::vector<const Image*>& residual,
                                      int threads);

/// What noise there is in a mosaic's principal solution, of weights that are 1/σ²: with C = H⁻¹ of each pixel images of √C_00,
/// of √C_11, and of their correlation C_01/√(C_00 C_11). The first two are in units of the noise of R_0, or over `seen` where
/// R_0 was divided by it, a primary beam. NaN where samples do not tell the terms apart.
struct SolutionNoise {
  Image sigma_0;
  Image sigma_1;
  Image correlation;
};
SolutionNoise solution_noise(const std::vector<Image>& relative_peaks, const Image* seen, int threads);

/// Of the PSFs' middle pixels. [k], 2n − 1 of them.
TaylorBasis basis_of(const std::vector<const Image*>& psf);

/// |y| of each pixel of residual images [term]; NaN where one of them is.
Image brightness(const TaylorBasis& basis, const std::vector<const Image*>& residual, int threads);

/// The principal solution: images of I [term], Jy/beam.
std::vector<Image> principal_solution(const TaylorBasis& basis, const std::vector<const Image*>& residual, int threads);

}  // namespace misfit::imager
