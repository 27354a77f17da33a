#pragma once

#include <memory>
#include <string>

#include "imager/files/image_reader.h"
#include "imager/files/image_writer.h"

namespace misfit::ms_io {

/// Begins a CASA image, the folder of a casacore PagedImage, that finish() leaves at `path`, in place of a casacore image that
/// is there; until then it lies beside it. Axes: right ascension, declination, Stokes, frequency, with the coordinates of
/// create_fits_image(). It has one beam where all planes share one, otherwise one for each (see plane_beams.h); the mask mask0
/// where pixels have no value, which are NaN too; cards as miscellaneous information. Throws std::runtime_error that names the
/// path, where it cannot be written or where anything else than a casacore image lies.
std::unique_ptr<imager::ImageWriter> create_casa_image(const imager::ImageHeader& header, const std::string& path,
                                                       imager::PixelFormat format = imager::PixelFormat::float32);

/// How pixels are read that a CASA image's default mask leaves out.
enum class Masks {
  applied,  ///< as NaN
  ignored,  ///< as they are stored
};

/// Opens a CASA image whose pixels lie on the sky as `grids` wants, with planes along a linear spectral axis and a Stokes axis
/// if there are any. Throws std::runtime_error that names the path and what was expected.
std::unique_ptr<imager::ImageReader> open_casa_image(const std::string& path, imager::Grids grids = imager::Grids::upright,
                                                     Masks masks = Masks::applied);

/// True if a casacore image lies at `path`, whoever wrote it. Throws std::runtime_error where it is a table that casacore must
/// not read.
bool is_casa_image(const std::string& path);

/// True if create_casa_image() wrote it.
bool is_own_casa_image(const std::string& path);

}  // namespace misfit::ms_io
