#pragma once

#include <cstddef>

#include "imager/tiled_psf.h"

namespace misfit::imager {

/// The part of factor × PSF that falls on rows [first_row, end_row) and columns [first_column, end_column) of a tile.
struct PsfPatch {
  const float* psf;  ///< at the first row and column
  float factor;
  int first_row;
  int end_row;
  int first_column;
  int end_column;
};

/// Takes patches of a PSF, whose rows lie `psf_columns` apart, off a tile one after the other. Returns the largest magnitude
/// that is left; −∞ where all pixels are NaN.
float subtract_and_peak(float* tile, const PsfPatch* patches, std::size_t count, std::ptrdiff_t psf_columns);

/// value[i] −= factor · psf[offset[i]] for i in [0, count).
void subtract_at(const float* psf, float factor, const int* offset, std::size_t count, float* value);

/// bound[i] += amount · reach[i] for i in [0, count), rounded upwards; returns the largest bound. None of them is NaN.
float raise_bounds(float* bound, const float* reach, int count, float amount);

}  // namespace misfit::imager
