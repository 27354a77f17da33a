#pragma once

#include "imager/image.h"

namespace misfit::imager {

/// An elliptical Gaussian: full widths at half maximum and the position angle of the major axis, from north through east.
struct Beam {
  double major_rad = 0;
  double minor_rad = 0;
  double position_angle_rad = 0;  ///< in (−π/2, π/2]
};

/// The Gaussian that fits the main lobe of `psf` best in the least-squares sense. The peak is fixed at the centre pixel (row
/// height/2, column width/2) with height 1; the pixels used are those connected to it above `cutoff`, the choice of CASA's
/// tclean. Throws std::runtime_error when the main lobe holds too few pixels (fewer than 3 unknowns) or the fit fails.
Beam fit_beam(const Image& psf, double cell_rad, double cutoff = 0.35);

/// model ⊗ beam, where the beam has peak 1: Jy/pixel in, Jy/beam out. Summed over the components directly, out to where the
/// beam falls below 1e-8 of its peak.
Image convolve_with_beam(const Image& model, const Beam& beam, double cell_rad, int threads);

}  // namespace misfit::imager
