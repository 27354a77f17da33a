#pragma once

#include "imager/data/image.h"

namespace misfit::imager {

/// An elliptical Gaussian: full widths at half maximum and the position angle of the major axis, from north through east.
struct Beam {
  double major_rad = 0;
  double minor_rad = 0;
  double position_angle_rad = 0;  ///< in (−π/2, π/2]
};

/// The pixels of a PSF that a beam is fitted to.
enum class BeamRegion {
  /// The pixels above 0.35 of the centre's height that are connected to it, CASA tclean's choice: the fit turns with the PSF.
  /// Where these are fewer than 30 pixels, points between them are fitted too, so that the cell may be coarse; see main_lobe.h.
  main_lobe,
  /// The pixels to the north and west alone, eight times as far as the main lobe reaches. WSClean 3.1 fits these, since its
  /// unsigned offsets put the other three quadrants at infinity, and no lobe or box about the centre gives its beams; the fit
  /// depends on how the PSF is turned. For comparison only. Where the quadrant fits no bounded Gaussian the main lobe is used.
  quadrant,
};

/// The Gaussian exp(−½ xᵀ P x) that fits `psf` best in the least-squares sense, with its peak of height 1 at the centre pixel
/// (row height/2, column width/2). Throws std::runtime_error where the main lobe has too few samples for three
/// unknowns, or the fit fails.
Beam fit_beam(const Image& psf, double cell_rad, BeamRegion region = BeamRegion::main_lobe);

/// The round Gaussian that fits the main lobe best, where no elliptical one does: a lobe that does not fall off along one of
/// its axes. Throws std::runtime_error as fit_beam does.
Beam fit_circular_beam(const Image& psf, double cell_rad);

/// √(mean of (PSF − beam)²) over the main lobe's samples; 0 where it has none.
double beam_misfit(const Image& psf, const Beam& beam, double cell_rad);

/// model ⊗ beam, where the beam has peak 1: Jy/pixel in, Jy/beam out; NaN in the model counts as 0. Summed over the components
/// directly, out to where the beam falls below 1e-8 of its peak; the same bits for any number of threads. Throws
/// std::invalid_argument when an axis of the beam or the cell is not positive.
Image convolve_with_beam(const Image& model, const Beam& beam, double cell_rad, int threads);

/// CLEAN's images of a plane, of one shape.
struct CleanedPlane {
  const Image& model;     ///< Jy/pixel
  const Image& residual;  ///< Jy/beam
};

/// model ⊗ beam + residual, see convolve_with_beam(). Throws what that does, and std::invalid_argument where the shapes differ.
Image restored(const CleanedPlane& plane, const Beam& beam, double cell_rad, int threads);

}  // namespace misfit::imager
