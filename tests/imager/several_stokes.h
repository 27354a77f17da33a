#pragma once

#include <algorithm>
#include <limits>
#include <memory>

#include "tests/imager/random_samples.h"

namespace misfit::imager::testing {

/// `first` with so many other Stokes parameters: other random visibilities of the same samples.
inline VisibilityBlock with_others(VisibilityBlock first, int others, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<float> normal;
  for (std::size_t left = static_cast<std::size_t>(others) * first.samples(); left > 0; --left)
    first.visibility.emplace_back(normal(random), normal(random));
  return first;
}

/// Both, of the same samples, in one block.
inline VisibilityBlock together(VisibilityBlock one, const VisibilityBlock& other) {
  one.visibility.insert(one.visibility.end(), other.visibility.begin(), other.visibility.end());
  return one;
}

/// The block of one of its Stokes parameters, alone.
inline VisibilityBlock alone(const VisibilityBlock& block, std::size_t stokes) {
  VisibilityBlock one = block;
  one.visibility.assign(block.visibility_of(stokes), block.visibility_of(stokes) + block.samples());
  return one;
}

}  // namespace misfit::imager::testing
