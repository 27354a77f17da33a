#pragma once

#include <complex>
#include <vector>

#include "imager/beams/row_beams.h"
#include "imager/data/source.h"
#include "imager/data/visibilities.h"

namespace misfit::imager {

/// The visibilities of sources that dishes see through their beams, V = Σ B(s) V_s with the beam B of each row and channel, by
/// direct sums, see predict_sources(). [row][channel], in Jy; the coordinates have the sights of their rows.
std::vector<std::complex<double>> predict_seen_sources(const std::vector<Source>& sources, const RowBeams& beams,
                                                       const SampleCoordinates& at, int threads);

}  // namespace misfit::imager
