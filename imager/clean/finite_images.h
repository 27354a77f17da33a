#pragma once

#include "imager/data/image.h"
#include "imager/data/image_statistics.h"

namespace misfit::imager {

/// Throws std::runtime_error where the PSF's middle pixel is not finite, or another infinite.
void require_finite_psf(const Image& psf);

/// Throws std::runtime_error where a residual is infinite, or NaN in more pixels than the dirty image, which is NaN beyond the
/// horizon.
void require_finite_residual(const ImageStatistics& residual, const ImageStatistics& dirty);

}  // namespace misfit::imager
