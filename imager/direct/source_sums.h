#pragma once

#include <complex>
#include <vector>

#include "imager/data/source.h"
#include "imager/data/visibilities.h"

namespace misfit::imager {

/// The visibilities of `sources` by their definition, added up [row][channel], in Jy; w is taken as 0 unless `with_w`. Double
/// precision throughout: each source is right to 1e-12 of its flux and to the rounding of its phase, 2πi times 1e-15 of
/// |ul| + |vm| + |w(n−1)|. The number of threads does not change a bit.
std::vector<std::complex<double>> predict_sources(const std::vector<Source>& sources, const SampleCoordinates& at, int threads,
                                                  bool with_w = true);

}  // namespace misfit::imager
