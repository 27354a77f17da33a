#pragma once

#include <memory>
#include <vector>

#include "imager/taylor/taylor_expansion.h"
#include "imager/transform/imaging.h"

namespace misfit::imager {

/// Images that wide-band CLEAN needs besides the dirty image R_0 and the PSF P_0.
struct TaylorImages {
  std::vector<Image> dirty;  ///< [t − 1], 1 ≤ t < terms: R_t = A*(w x^t V) / Σ w, Jy/beam
  std::vector<Image> psf;    ///< [k − 1], 1 ≤ k ≤ 2 terms − 2: P_k = A*(w x^k) / Σ w, of a source in the middle pixel
  /// [k − 1], 1 ≤ k ≤ 2 terms − 2: P_k over P_0 of a source in each pixel, for a mosaic, whose pixels are seen at unlike
  /// frequencies; empty where it is the same in all pixels.
  std::vector<Image> relative_peaks{};
  std::shared_ptr<const Image> divided_by{};  ///< a mosaic's primary beam, where images are a flat sky
};

/// Makes all of them in one pass over the visibilities: dirty images by `transform`, PSFs by `psf`, which may be the same. A
/// sky of Taylor coefficients I_t has R_q = Σ_t P_{q+t} ⋆ I_t, the normal equations of Rau & Cornwell (2011). With ν_0 in the
/// middle of the band R_t and P_k of odd t and k are weak against their data: the transforms' errors are relative to the images
/// of |x^t V| rather than to R_t and P_k. Stages timed: "read", "grid", "fft".
TaylorImages make_taylor_images(const ImagedData& imaged, const Transform& psf, const TaylorExpansion& expansion,
                                const Context& context);

/// The residual images A*(w x^t (V − Σ_s x^s A I_s)) / Σ w [t], of model images [s] of each term, in one pass. Stages timed: as
/// by make_residual_image.
std::vector<Image> make_taylor_residuals(const ImagedData& imaged, std::vector<Image> models, const TaylorExpansion& expansion,
                                         const Context& context);

}  // namespace misfit::imager
