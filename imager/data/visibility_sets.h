#pragma once

#include <complex>
#include <variant>
#include <vector>

#include "imager/data/visibilities.h"

namespace misfit::imager {

/// The Stokes parameters that are imaged at once at most.
inline constexpr int most_stokes = 4;

/// Visibilities [row][channel] at the samples of a block, of either precision.
using VisibilitySet = std::variant<const std::complex<float>*, const std::complex<double>*>;

/// Those that `images` images are made of: the block's own for one image, else also those of its other Stokes parameters.
/// Throws std::invalid_argument when the block does not carry as many, or not of as many samples.
std::vector<VisibilitySet> sets_of(const VisibilityBlock& block, int images);

}  // namespace misfit::imager
