#pragma once

#include <casacore/casa/Arrays/IPosition.h>
#include <casacore/coordinates/Coordinates/CoordinateSystem.h>

#include <optional>
#include <string>

#include "imager/files/image_header.h"
#include "imager/files/image_writer.h"
#include "imager/files/sky_grid.h"

namespace misfit::ms_io {

/// Observation::moving_at, among an image's miscellaneous information.
constexpr const char* moving_key = "TRACKFLD";

/// Direction, Stokes and spectral coordinates, and what the header says of the observation.
casacore::CoordinateSystem casa_coordinates(const imager::ImageHeader& header);

/// Where the planes of an image lie among its axes.
struct CasaPlanes {
  casacore::IPosition shape;  ///< pixels along each axis
  int stokes = -1;            ///< the Stokes axis; -1 = none
  int spectral = -1;          ///< the spectral axis; -1 = none
  bool celestial = true;      ///< whether the first two say where pixels lie on the sky

  casacore::IPosition first_pixel(const imager::PlaneIndex& at) const;
  /// The shape of one plane.
  casacore::IPosition plane_shape() const;
};

/// Checks the coordinates of an image's table, in its keyword "coords". Throws std::runtime_error(`path` …) where directions
/// are in a frame that in_frame() does not know: casacore fails over some frames without a reason.
void check_frames(const casacore::RecordInterface& coordinates, const std::string& path);

/// Throws std::runtime_error(`path` …) where a longitude and a latitude are not the first two axes, or another than the Stokes
/// and the spectral axis is longer than 1 or has a name that means something.
CasaPlanes find_planes(const casacore::CoordinateSystem& coordinates, const casacore::IPosition& shape,
                       const std::string& path);

/// The header that coordinates give, but for the unit and where pixels lie on the sky. Stokes and spectral coordinates without
/// an axis of pixels say of all pixels which Stokes parameter and frequency they are of. Throws std::runtime_error(`path` …)
/// where the spectral axis is not linear.
imager::ImageHeader header_of(const casacore::CoordinateSystem& coordinates, const CasaPlanes& planes, const std::string& path);

/// Where the pixels lie on the sky, in a frame that check_frames() knows; none where the image has no directions. Throws
/// std::runtime_error(`path` …) where they are in another projection than SkyGrid has.
std::optional<imager::SkyGrid> grid_of(const casacore::CoordinateSystem& coordinates, const CasaPlanes& planes,
                                       const std::string& path);

}  // namespace misfit::ms_io
