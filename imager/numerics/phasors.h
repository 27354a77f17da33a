#pragma once

namespace misfit::imager {

/// cosine[i] + i sine[i] = exp(2πi turns[i]), right to the rounding of `turns`: what is reduced is turns, not radians.
void phasors(const double* turns, int count, double* cosine, double* sine);

}  // namespace misfit::imager
