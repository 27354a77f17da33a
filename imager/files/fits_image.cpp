#include "imager/files/fits_image.h"

#include <stdexcept>
#include <utility>

#include "imager/files/fits_image_reader.h"
#include "imager/files/fits_image_writer.h"

namespace misfit::imager {
namespace {

using Planes = std::vector<const SkyImage*>;

ImageHeader header_of(const Planes& planes) {
  if (planes.empty()) throw std::invalid_argument("a FITS image of no planes; expected one at least");
  const SkyImage& sky = *planes.front();
  ImageHeader header{sky.geometry, sky.observation, whole_band(sky.observation), {}, sky.unit, sky.cards, sky.history};
  for (const SkyImage* plane : planes) header.stokes.push_back(plane->stokes);
  return header;
}

void write_planes(const Planes& planes, const std::string& path, PixelFormat format) {
  const auto writer = create_fits_image(header_of(planes), path, format);
  for (std::size_t s = 0; s < planes.size(); ++s)
    writer->write({0, static_cast<int>(s)}, planes[s]->image,
                  planes[s]->has_beam ? std::optional(planes[s]->beam) : std::nullopt);
  writer->finish();
}

SkyImage sky_image(const ImageReader& file, const PlaneIndex& at) {
  const ImageHeader& header = file.header();
  return {file.read(at),
          header.geometry,
          header.observation,
          header.stokes.at(static_cast<std::size_t>(at.stokes)),
          header.unit,
          false,
          {},
          {},
          {}};
}

}  // namespace

void write_fits(const SkyImage& image, const std::string& path, PixelFormat format) {
  write_planes({&image}, path, format);
}

void write_fits(const std::vector<SkyImage>& images, const std::string& path, PixelFormat format) {
  Planes planes;
  for (const SkyImage& image : images) planes.push_back(&image);
  write_planes(planes, path, format);
}

std::vector<SkyImage> read_channel(const ImageReader& file, int channel) {
  std::vector<SkyImage> images;
  for (int s = 0; s < static_cast<int>(file.header().stokes.size()); ++s) images.push_back(sky_image(file, {channel, s}));
  return images;
}

SkyImage read_fits(const std::string& path) {
  std::vector<SkyImage> planes = read_stokes_images(path);
  if (planes.size() > 1)
    throw std::runtime_error("cannot read " + path + ": it has planes of " + std::to_string(planes.size()) +
                             " Stokes parameters; expected one");
  return std::move(planes.front());
}

std::vector<SkyImage> read_stokes_images(const std::string& path) {
  const auto file = open_fits_image(path);
  if (const int channels = file->header().spectral.channels; channels > 1)
    throw std::runtime_error("cannot read " + path + ": it has planes of " + std::to_string(channels) +
                             " frequencies; expected one");
  std::vector<SkyImage> images = read_channel(*file, 0);
  for (int s = 0; s < static_cast<int>(images.size()); ++s) {
    const std::optional<Beam> beam = file->beam({0, s});
    images[static_cast<std::size_t>(s)].has_beam = beam.has_value();
    images[static_cast<std::size_t>(s)].beam = beam.value_or(Beam{});
  }
  return images;
}

}  // namespace misfit::imager
