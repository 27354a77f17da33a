#pragma once

#include <cstddef>

#include "imager/clean/component_log.h"
#include "imager/clean/tiled_psf.h"

namespace misfit::imager {

/// Takes components off a block of pixels [row][column] whose first lies at (row, column) of the image.
void subtract(const TiledPsf& psf, PointComponents components, int row, int column, float* block);

/// The largest magnitude of a block's pixels; −∞ where all are NaN.
float largest_magnitude(const float* block);

/// bound[i] += amount · reach[i] for i in [0, count), rounded upwards; returns the largest bound. None of them is NaN.
float raise_bounds(float* bound, const float* reach, int count, float amount);

/// The same for the blocks [row][column] of the tile whose first pixel lies at (row, column) of the image, and components.
void raise_block_bounds(const Reach& reach, PointComponents components, int row, int column, float* bound);

}  // namespace misfit::imager
