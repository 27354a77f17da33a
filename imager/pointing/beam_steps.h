#pragma once

#include <cstddef>
#include <vector>

#include "imager/beams/row_beams.h"
#include "imager/pointing/beam_terms.h"

namespace misfit::imager {

/// At which frequencies and turns the beams of rows are made, so that all others follow.
struct BeamSteps {
  std::vector<BeamSpan> spans;
  std::vector<double> largest;  ///< [term]: how large it is at most in any span, over the beams' peak
  double turn_rad = 0;          ///< by which beams that are not round are turned at a time; 0: exactly as they lie
};

/// Steps by which beams follow, over their peak, to `tolerance` between frequencies, and are turned wrongly by four times that
/// at most, as far as `reach`, sin θ from their axes. Where formulas end in a step nothing is promised. A
/// span has `most_nodes` at most.
BeamSteps beam_steps(const RowBeams& beams, double reach, const std::vector<double>& frequency_hz, double tolerance,
                     std::size_t most_nodes = 12);

}  // namespace misfit::imager
