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
  for (int i = 0; i < others; ++i) {
    auto other = std::make_shared<VisibilityBlock>(first);
    other->other_stokes.clear();
    for (auto& visibility : other->visibility) visibility = {normal(random), normal(random)};
    first.other_stokes.push_back(std::move(other));
  }
  return first;
}

/// The block of one of its Stokes parameters, alone.
inline VisibilityBlock alone(const VisibilityBlock& block, std::size_t stokes) {
  VisibilityBlock one = stokes == 0 ? block : *block.other_stokes[stokes - 1];
  one.other_stokes.clear();
  return one;
}

}  // namespace misfit::imager::testing
