#pragma once

#include <string>
#include <vector>

#include "imager/plan/gridding_choice.h"
#include "tools/kernel_choice/kernel_choice.h"

namespace misfit::tools {

/// A job for which width, padding, precision and degree are to be chosen.
struct KernelJob {
  KernelSource kernel;
  double accuracy = 0;
  std::vector<int> imsize;  ///< width, or width and height, in pixels
  double samples = 0;       ///< visibilities
  double w_turns = 0;       ///< range of w in wavelengths times the image's range of n − 1; 0 = two axes
};

/// The cheapest gridding for the job; std::invalid_argument names the value that cannot be meant, or the accuracy that can be
/// had.
imager::GriddingChoice choose_for(const KernelJob& job);

/// The choice, what it costs by this machine's constants and in operations, and its rejected neighbours, as lines of text.
std::string text_of(const imager::GriddingChoice& choice, const imager::CostModel& costs);

}  // namespace misfit::tools
