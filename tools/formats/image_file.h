#pragma once

#include <memory>
#include <string>

#include "imager/files/image_reader.h"
#include "ms_io/casa_image.h"

namespace misfit::tools {

/// Opens an image whose pixels lie on the sky as `grids` wants: a CASA image where `path` is a folder, a FITS image otherwise.
/// Throws what open_casa_image() and open_fits_image() throw.
std::unique_ptr<imager::ImageReader> open_image_file(const std::string& path, imager::Grids grids = imager::Grids::upright,
                                                     ms_io::Masks masks = ms_io::Masks::applied);

/// The channel of `file` for channel `channel` of an image with this spectral axis: the only one, or the same one where the
/// file has the image's planes, to a tenth of their width. Throws std::runtime_error(`path` …) where it has others.
int channel_for(const imager::ImageReader& file, const std::string& path, const imager::SpectralAxis& axis, int channel);

/// True if the band that a file states and the band of data or an image lie apart by more than a thousandth of the frequency,
/// by which frames may shift bands. A file that states no band lies apart from none.
bool bands_apart(const imager::Observation& file, const imager::Observation& data);

/// How far apart two directions are, as direction cosines; infinity where one lies beyond the other's horizon.
double cosine_distance(const imager::SkyDirection& one, const imager::SkyDirection& other);

}  // namespace misfit::tools
