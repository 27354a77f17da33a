#pragma once

#include <string>
#include <utility>
#include <vector>

#include "imager/beam.h"
#include "imager/geometry.h"
#include "imager/image.h"
#include "imager/image_header.h"

namespace misfit::imager {

/// An image on the sky with what its header states. FITS axes: RA---SIN, DEC--SIN, FREQ, STOKES, in this order. CRVAL is
/// the phase centre and CRPIX the place where l = m = 0, be it between pixels or outside the image. NaN marks a pixel without
/// value.
struct SkyImage {
  Image image;
  ImageGeometry geometry;
  Observation observation;
  Stokes stokes = Stokes::I;
  std::string unit = "Jy/beam";
  bool has_beam = false;
  Beam beam;
  std::vector<HeaderCard> cards;
  std::vector<std::string> history;
};

enum class PixelFormat { float32, float64 };

/// Writes `image` to `path`, replacing what is there. The file appears under its name only when complete (it is written
/// beside it and renamed). Throws std::runtime_error that names the path and CFITSIO's reason.
void write_fits(const SkyImage& image, const std::string& path, PixelFormat format);

/// The same of images that differ in their pixels and Stokes parameters alone, as planes along the STOKES axis. Throws
/// std::invalid_argument when there are none, they differ in size, or their codes are not evenly spaced.
void write_fits(const std::vector<SkyImage>& planes, const std::string& path, PixelFormat format);

/// Reads the first plane of the primary image of a FITS file with a SIN (or no) projection, in any pixel type. Throws
/// std::runtime_error that names the path when it cannot be read, is no two-dimensional image (axes beyond the second must have
/// length 1), or has pixels that are not square.
SkyImage read_fits(const std::string& path);

/// The same for each plane of an image whose STOKES axis may be longer than 1, in the order of the file. Throws where a plane
/// is none that Stokes names, or two are of the same.
std::vector<SkyImage> read_stokes_images(const std::string& path);

}  // namespace misfit::imager
