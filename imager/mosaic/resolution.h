#pragma once

#include <array>
#include <vector>

#include "imager/beams/beam.h"
#include "imager/data/image.h"
#include "imager/files/sky_grid.h"

namespace misfit::imager {

/// True where no beam is wider than another by more than a thousandth; all are compared by way of the first.
bool of_one_resolution(const std::vector<Beam>& beams);

/// From one beam to another that encloses it, both with position angles about the grid's north.
struct BeamChange {
  Beam from;
  Beam to;
};

/// A plane on the pixels of `grid` in Jy per `from`, convolved with the Gaussian that makes that beam the other, in Jy per
/// `to`: with the covariances Σ of the beams,
///     F → F · exp(−2π² fᵀ (Σ_to − Σ_from) f) · area_to / area_from
/// at the frequency f. A point source keeps its peak. Directions in which `to` is shorter, as rounding may leave it, stay as
/// they are. NaN counts as 0, and so do places beyond the border; pixels are NaN where more than 1 % of their Gaussian lies on
/// these. The number of threads does not change a bit.
Image with_beam(const Image& image, const BeamChange& change, const SkyGrid& grid, int threads);

}  // namespace misfit::imager
