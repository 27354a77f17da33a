#pragma once

#include <optional>
#include <vector>

#include "imager/data/image.h"
#include "imager/taylor/taylor_basis.h"

namespace misfit::imager {

/// Spectra as power laws about the reference frequency, I(ν) = I_0 (ν/ν_0)^(α + β ln(ν/ν_0)), whose first Taylor coefficients
/// are I_1 = α I_0 and I_2 = (α (α − 1)/2 + β) I_0 (Rau & Cornwell 2011, A&A 532, A71).
struct SpectralImages {
  Image alpha;          ///< α = I_1/I_0
  Image alpha_error;    ///< one standard deviation of α by noise
  Image beta;           ///< β = I_2/I_0 − α (α − 1)/2; empty of two terms
  double level_jy = 0;  ///< of I_0, below which the other images are NaN; in a mosaic each pixel has its own
};

/// The spectral images of restored images [term] of two terms or more. Their noise is the noise of `residual`, the principal
/// solutions of CLEAN's residuals. With σ_0, σ_1 their robust noise and c its covariance,
///
///     σ_α² = (σ_1² − 2 α c + α² σ_0²)/I_0²,
///
/// to first order in noise over I_0. NaN where I_0 is less than five times σ_0. In a mosaic σ_0, σ_1 and c differ from pixel to
/// pixel as `by` says.
SpectralImages spectral_images(const std::vector<Image>& restored, const std::vector<Image>& residual, int threads,
                               const std::optional<SolutionNoise>& by = std::nullopt);

/// α and β of `sky`, images [term] of the same sources without the beam, where `apparent` has them and I_0 is positive; without
/// errors, which are those of `apparent`, as the beam's own α has no noise.
SpectralImages spectral_images_of_sky(const std::vector<Image>& sky, const SpectralImages& apparent, int threads);

}  // namespace misfit::imager
