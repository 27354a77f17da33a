#pragma once

#include <cstddef>
#include <vector>

#include "imager/beams/frequency_nodes.h"
#include "imager/beams/row_beams.h"

namespace misfit::imager {

/// At which frequencies and turns the beams of rows are made, so that all others follow.
struct BeamSteps {
  std::vector<FrequencySpan> spans;
  double turn_rad = 0;  ///< by which beams that are not round are turned at a time; 0: exactly as they lie
};

/// The turns by which beams that are not round are turned at a time, wrong by four times the tolerance over their peak at most
/// as far as `reach`, sin θ from their axes; 0 for round ones.
double turn_step(const RowBeams& beams, double reach, double frequency_hz, double tolerance);

/// Steps by which beams follow, over their peak, to `tolerance` between frequencies, and are turned wrongly by four times that
/// at most, as far as `reach`, sin θ from their axes. Where formulas end in a step nothing is promised. A
/// span has `most_nodes` at most.
BeamSteps beam_steps(const RowBeams& beams, double reach, const std::vector<double>& frequency_hz, double tolerance);

}  // namespace misfit::imager
