#pragma once

#include <vector>

#include "kernels/evaluation.h"

namespace misfit::tools {

struct SpeedOptions {
  int visibilities = 20000;  ///< a run
  int runs = 9;
};

/// Nanoseconds that each way takes for a visibility: its taps along u and v at random positions, on one core. Runs of all ways
/// alternate, so that they share what else the machine does, and each answer is the median of its runs.
std::vector<double> nanoseconds_a_visibility(const std::vector<kernels::Evaluation>& ways, const SpeedOptions& options);

}  // namespace misfit::tools
