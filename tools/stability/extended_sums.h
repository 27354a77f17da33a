#pragma once

#include <complex>
#include <vector>

#include "imager/data/visibilities.h"
#include "imager/direct/direct_transform.h"

namespace misfit::tools {

/// Σ w Re[V exp(−2πi(ul+vm+w(n−1)))] / Σ w at pixels, in extended precision: phases of 10⁶ turns and more have rounding in
/// double that this is to show. Samples beyond 1/(2 cell) are left out, as in imaging.
std::vector<double> extended_pixels(const imager::VisibilityBlock& block, const imager::ImageGeometry& geometry,
                                    const std::vector<imager::Pixel>& pixels);

/// The visibilities of `model` at `at`, a sum over its pixels that are not 0. [row][channel]
std::vector<std::complex<double>> extended_visibilities(const imager::SampleCoordinates& at,
                                                        const imager::ImageGeometry& geometry, const imager::Image& model);

}  // namespace misfit::tools
