#pragma once

#include <complex>
#include <vector>

#include "imager/data/phase.h"
#include "imager/data/visibilities.h"

namespace misfit::imager {

/// exp(+2πi(ul+vm+w(n−1))), the visibilities of a source of 1 Jy. [row][channel]
std::vector<std::complex<double>> unit_source(const SampleCoordinates& at, const PhasePosition& source, int threads);

}  // namespace misfit::imager
