#pragma once

#include "imager/data/image.h"

namespace misfit::imager {

/// True if a mask lets CLEAN take components from a pixel of this value: neither 0 nor NaN.
bool mask_allows(double value);

/// How many pixels a mask allows.
std::size_t allowed_pixels(const Image& mask);

/// True if a mask allows no pixel at all.
bool mask_is_empty(const Image& mask);

/// The largest magnitude of a pixel that a mask of the same size allows; 0 where none is allowed, or all are NaN.
double largest_magnitude_within(const Image& mask, const Image& image, int threads);

/// `image` with NaN wherever a mask of the same size allows nothing.
Image masked(Image image, const Image& mask);

}  // namespace misfit::imager
