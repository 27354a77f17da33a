#pragma once

#include <complex>
#include <cstddef>
#include <variant>
#include <vector>

#include "imager/data/visibilities.h"

namespace misfit::imager {

/// The most Stokes parameters that are imaged at once.
inline constexpr int most_stokes = 4;

/// Visibilities [row][channel] at the samples of a block, of either precision.
using VisibilitySet = std::variant<const std::complex<float>*, const std::complex<double>*>;

/// Visibilities at the samples of a block, a set of them for each image.
class VisibilitySets : public std::vector<VisibilitySet> {
 public:
  VisibilitySets() = default;
  /// The block's own visibilities: of its first Stokes parameter for one image, else of all. Throws std::invalid_argument when
  /// the block does not carry as many.
  VisibilitySets(const VisibilityBlock& block, int images);
  /// One set, [row][channel], of one image. No value is copied, here or below.
  VisibilitySets(const std::vector<std::complex<double>>& one) : vector{one.data()} {}
  VisibilitySets(VisibilitySet one) : vector{one} {}
  /// A set for each of several images, [image][row][channel].
  VisibilitySets(const std::vector<std::vector<std::complex<double>>>& several);
};

}  // namespace misfit::imager
