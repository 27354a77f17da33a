#pragma once

#include <array>
#include <optional>
#include <vector>

#include "imager/beams/beam_tables.h"
#include "imager/beams/primary_beam.h"
#include "imager/data/geometry.h"
#include "imager/data/image.h"
#include "imager/taylor/taylor_expansion.h"

namespace misfit::imager {

/// The primary beam of images of Taylor terms. Samples of weights w at distances x from the reference frequency see a source
/// off axis as B(x) I(x), where B is their beam. The coefficients c that CLEAN finds belong to the polynomial that fits this
/// best, and the sky's coefficients J to the polynomial whose product with B fits it best:
///
///     H c = R,   H_qt = Σ w x^(q+t) / Σ w,     R_q = Σ w x^q B I / Σ w,
///     G J = R,   G_qt = Σ w x^(q+t) B / Σ w,   so that   J = G⁻¹ H c.
///
/// This divides the polynomial c by the beam (Rau & Cornwell 2011, A&A 532, A71) with the weights and in the basis by which c
/// was found. It is exact for each spectrum that is a polynomial of so many terms, whatever B is; what it neglects is the rest
/// of the spectrum, of order x^terms, as all images of terms do. In narrow bands it is the division of polynomials by the
/// beam's own terms
///
///     b = H⁻¹ (Σ w x^q B / Σ w)_q,   J_0 = c_0/b_0,   J_1 = (c_1 − b_1 J_0)/b_0,   J_2 = (c_2 − b_1 J_1 − b_2 J_0)/b_0,
///
/// which cuts off the parts of products of order x^terms: for α = −0.7 where an Airy disc is at 0.25, over 40 % of the
/// frequency, two terms of this division have α = −0.64, two terms of J −0.73, and without a beam α is −0.71.
class TaylorBeam {
 public:
  using Moments = std::array<double, 2 * most_taylor_terms - 1>;  ///< [power of x]; 0 beyond 2 terms − 1

  /// The beam of samples that make these shares of the images. Images have no value beyond where b_0 first falls to the limit.
  /// Throws std::invalid_argument where PrimaryBeam and primary_beam_image() do.
  TaylorBeam(const std::vector<BeamShare>& shares, const TaylorExpansion& expansion, const ImageGeometry& geometry,
             const BeamOnImage& view);

  /// b [term]: the images of a source of 1 Jy with a flat spectrum.
  std::vector<Image> terms() const;
  /// J [term], from c [term].
  std::vector<Image> corrected(const std::vector<const Image*>& apparent) const;

 private:
  /// The images of terms_at(pixel, moments of the beam there), where images have values.
  template <typename TermsAt>
  std::vector<Image> images_of(const TermsAt& terms_at) const;

  TaylorExpansion expansion_;
  ImageGeometry geometry_;
  BeamOnImage view_;
  Moments weight_moment_{};                ///< Σ w x^k / Σ w
  std::optional<BeamTables> beam_moment_;  ///< Σ w x^k B / Σ w [k], 2 terms − 1 of them
};

}  // namespace misfit::imager
