#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "imager/data/stokes.h"
#include "imager/files/fits_file.h"

namespace misfit::imager {

/// An axis of a FITS header: pixel p, counted from 1, has the value reference_value + (p − reference_pixel) · increment.
struct FitsAxis {
  std::string type;
  std::string unit;
  double reference_pixel = 1;
  double reference_value = 0;
  double increment = 1;
};

/// The STOKES axis of these Stokes parameters. Throws std::invalid_argument where there are none, or their codes are not
/// evenly spaced.
FitsAxis stokes_axis(const std::vector<Stokes>& stokes);

/// The change of each axis per pixel along each, [axis][along], in the unit of the axis: CDELTi · PCi_j, the first two turned
/// by CROTA2 where there is no PC, or CDi_j where there are such (Calabretta & Greisen 2002, section 2.1.2 and equation 186).
using FitsSteps = std::vector<std::vector<double>>;

/// Where the planes of a file lie among its axes, which count from 0.
struct FitsPlanes {
  std::size_t axes = 2;       ///< of pixels: NAXIS
  std::vector<long> lengths;  ///< of each axis of coordinates; 1 beyond those of pixels
  std::optional<std::size_t> spectral;
  std::optional<std::size_t> stokes;
  FitsSteps steps;
};

/// Axes that the header describes beyond those of pixels (FITS 4.0, section 8.2) have one pixel, and state the Stokes parameter
/// and frequency of all pixels. Throws std::runtime_error where the primary image has no two axes of pixels; where it has
/// further axes that are longer than 1 or have a type, except one spectral axis (see fits_spectral.h) and one of Stokes
/// parameters; where other axes than the first two depend on each other; or where keywords of their steps contradict each
/// other.
FitsPlanes find_planes(const FitsFile& file);

/// Reads an axis, counted from 0. A reference pixel must be stated: readers differ in where it lies otherwise.
FitsAxis read_axis(const FitsFile& file, const FitsPlanes& planes, std::size_t axis);

/// The first pixel of a plane, counted from 1 along each axis.
std::vector<long> first_pixel(const FitsPlanes& planes, const PlaneIndex& at);

/// The Stokes parameters in the order of the file; I where it has no such axis. Throws std::runtime_error where a plane is of a
/// parameter that Stokes does not have, or two are of the same.
std::vector<Stokes> read_stokes(const FitsFile& file, const FitsPlanes& planes);

}  // namespace misfit::imager
