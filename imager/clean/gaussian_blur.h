#pragma once

#include <vector>

#include "imager/data/image.h"

namespace misfit::imager {

/// exp(−4 ln 2 k²/fwhm²) over its sum at pixels k = 0, 1, …, as far as it exceeds 1e-9 of its peak; the other half is the same.
/// Throws std::invalid_argument unless fwhm_pixels > 0.
std::vector<double> gaussian_taps(double fwhm_pixels);

/// image ⊗ taps along rows ⊗ taps along columns: a unit of flux stays one, but for what leaves the image. Places beyond the
/// image, and NaN, count as 0. FFTs in double precision; the number of threads does not change a bit. Throws
/// std::invalid_argument unless fwhm_pixels > 0.
Image gaussian_blur(const Image& image, double fwhm_pixels, int threads);

}  // namespace misfit::imager
