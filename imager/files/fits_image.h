#pragma once

#include <string>
#include <vector>

#include "imager/beams/beam.h"
#include "imager/data/geometry.h"
#include "imager/data/image.h"
#include "imager/files/image_header.h"
#include "imager/files/image_reader.h"
#include "imager/files/image_writer.h"

namespace misfit::imager {

/// An image on the sky with its header: one plane of an image with an ImageHeader.
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

/// Writes `image` to `path` as create_fits_image() does.
void write_fits(const SkyImage& image, const std::string& path, PixelFormat format);

/// Writes images that differ in their pixels and Stokes parameters alone, as planes along the STOKES axis. Throws
/// std::invalid_argument when there are none, they differ in size, or their codes are not evenly spaced.
void write_fits(const std::vector<SkyImage>& planes, const std::string& path, PixelFormat format);

/// The planes of one channel of an image, in the order of its Stokes parameters, without beams: masks and models need none.
std::vector<SkyImage> read_channel(const ImageReader& file, int channel);

/// Reads the only plane, and its beam, of a FITS file that open_fits_image() opens. Throws std::runtime_error that names the
/// path where there are more.
SkyImage read_fits(const std::string& path);

/// Reads each plane, and its beam, of an image whose STOKES axis may be longer than 1, in the order of the file.
std::vector<SkyImage> read_stokes_images(const std::string& path);

}  // namespace misfit::imager
