#pragma once

#include "imager/image.h"

namespace misfit::imager {

/// image ⊗ exp(−4 ln 2 r²/fwhm²) / its sum over all pixels: a unit of flux stays one, but for what leaves the image. What lies
/// beyond the image, or is NaN, counts as 0. The Gaussian is cut where it falls below 1e-9 of its peak. The same bits for any
/// number of threads. Throws std::invalid_argument unless fwhm_pixels > 0.
Image gaussian_blur(const Image& image, double fwhm_pixels, int threads);

}  // namespace misfit::imager
