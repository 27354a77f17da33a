#pragma once

#include <casacore/casa/Arrays/IPosition.h>
#include <casacore/coordinates/Coordinates/CoordinateSystem.h>

#include <string>

#include "imager/image_header.h"
#include "imager/image_writer.h"

namespace misfit::ms_io {

/// Direction, Stokes and spectral coordinates, and what the header says of the observation.
casacore::CoordinateSystem casa_coordinates(const imager::ImageHeader& header);

/// Where the planes of an image lie among its axes.
struct CasaPlanes {
  casacore::IPosition shape;  ///< pixels along each axis
  int stokes = -1;            ///< the Stokes axis; -1 = none
  int spectral = -1;          ///< the spectral axis; -1 = none

  casacore::IPosition first_pixel(const imager::PlaneIndex& at) const;
  /// Of one plane.
  casacore::IPosition plane_shape() const;
};

/// Throws std::runtime_error(`path` …) where the first two axes are not right ascension and declination, or another than the
/// Stokes and the spectral axis is longer than 1.
CasaPlanes find_planes(const casacore::CoordinateSystem& coordinates, const casacore::IPosition& shape,
                       const std::string& path);

/// What coordinates say, but for the unit. Throws std::runtime_error(`path` …) where the projection is not SIN with square
/// pixels and north up, or the spectral axis not linear.
imager::ImageHeader header_of(const casacore::CoordinateSystem& coordinates, const CasaPlanes& planes, const std::string& path);

}  // namespace misfit::ms_io
