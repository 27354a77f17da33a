#pragma once

#include "imager/data/image.h"

namespace misfit::imager {

/// Throws std::runtime_error where the PSF's middle pixel is not finite, or another infinite.
void require_finite_psf(const Image& psf);

/// Throws std::runtime_error where a residual is infinite, or NaN where the dirty image is not, which is within the horizon.
void require_finite_residual(const Image& residual, const Image& dirty);

}  // namespace misfit::imager
