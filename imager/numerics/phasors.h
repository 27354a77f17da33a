#pragma once

namespace misfit::imager {

/// cosine[i] + i sine[i] = exp(2πi turns[i]), right to the rounding of `turns`: arguments are reduced in turns, not in radians.
void phasors(const double* turns, int count, double* cosine, double* sine);

}  // namespace misfit::imager
