#pragma once

#include <string>

#include "imager/data/spectral_axis.h"
#include "imager/files/fits_axes.h"
#include "imager/files/fits_file.h"

namespace misfit::imager {

/// The types of axes that read_spectral_axis() reads, for messages.
constexpr const char* spectral_types = "FREQ, VRAD, VELO, VOPT, FELO, ZOPT or WAVE";

/// True if a CTYPE is one of these, in form: with AIPS's name of a frame behind it (FREQ-LSR, VELO-HEL), or FITS's name of its
/// sampling (VOPT-F2W).
bool is_spectral(const std::string& type);

/// The frequencies of the planes; RESTFRQ where there is no spectral axis. An axis states (Greisen et al. 2006, A&A 446, 747,
/// tables 1 and 3)
///     FREQ  ν         VRAD  c (1 − ν/ν₀)     VOPT, FELO  c (ν₀/ν − 1)     ZOPT  ν₀/ν − 1     WAVE  c/ν
/// with ν₀ from RESTFRQ. VELO is as VRAD where VELREF is above 256, as VOPT below, and without VELREF the velocity v of ν = ν₀
/// √((1 − v/c)/(1 + v/c)). Planes are evenly spaced in the axis' quantity, or in frequency where its type ends in F2W or F2V,
/// or is FELO; one plane has its own frequency and width. The frame is from SPECSYS, or else from AIPS's names, or from VELREF.
/// Throws std::runtime_error where a velocity has no rest frequency, a unit is not known, or several planes are evenly spaced
/// in a relativistic velocity.
SpectralAxis read_spectral_axis(const FitsFile& file, const FitsPlanes& planes);

}  // namespace misfit::imager
