// FITS images, as --mask, --startmodel and predict --model read them.
#include <cmath>

#include "imager/files/fits_image.h"
#include "tests/fuzz/fuzzing.h"
#include "tools/formats/image_file.h"
#include "tools/formats/mask_file.h"
#include "tools/formats/model_image.h"

using namespace misfit;
using namespace misfit::fuzz;

namespace {

/// What the seeds are of: 4 × 4 pixels of 1″, I and Q, three channels.
imager::ImageHeader image() {
  constexpr double degree = M_PI / 180;
  imager::ImageHeader header;
  header.geometry = {4, 4, degree / 3600, {10 * degree, 40 * degree, "FK5"}};
  header.stokes = {imager::Stokes::I, imager::Stokes::Q};
  header.spectral = {1.4e9, 1e6, 3, "LSRK", 1.42e9};
  return header;
}

void require_mask(const std::string& path) {
  const imager::ImageHeader of = image();
  const auto mask = read_or_refused(path, [&] { return std::make_unique<tools::MaskFile>(path, of); });
  if (!mask) return;
  for (int channel = 0; channel < of.spectral.channels; ++channel)
    for (int stokes = 0; stokes < 2; ++stokes) {
      const auto plane = read_or_refused(path, [&] { return (*mask)->mask({channel, stokes}); });
      require(!plane || plane->pixel.size() == of.geometry.pixels(), "a mask has the image's pixels");
      for (std::size_t i = 0; plane && i < plane->pixel.size(); ++i)
        require(plane->pixel[i] == 0 || plane->pixel[i] == 1, "a mask is 0 and 1");
    }
}

void require_header(const imager::ImageHeader& header) {
  const imager::ImageGeometry& g = header.geometry;
  require(g.width >= 1 && g.height >= 1 && header.spectral.channels >= 1 && !header.stokes.empty(), "an image has pixels");
  require(std::isfinite(g.cell_rad) && g.cell_rad > 0, "pixels have a size");
  require(std::isfinite(g.centre.l) && std::isfinite(g.centre.m), "the phase centre is a number of pixels away");
  require(std::isfinite(g.phase_centre.ra_rad) && std::isfinite(g.phase_centre.dec_rad), "the phase centre is a direction");
  const imager::SpectralAxis& axis = header.spectral;
  require(std::isfinite(axis.reference_hz) && std::isfinite(axis.increment_hz) && std::isfinite(axis.rest_frequency_hz),
          "planes have frequencies");
}

/// As the first plane of the image, or as each of its planes.
void require_models(const std::string& path) {
  const auto file = read_or_refused(path, [&] { return tools::open_image_file(path); });
  if (!file) return;
  require_header((*file)->header());
  for (int channel = 0; channel < 3; ++channel) {
    const auto planes = read_or_refused(path, [&] {
      return tools::read_model_channel(**file,
                                       {path, tools::channel_for(**file, "start model " + path, image().spectral, channel)});
    });
    for (std::size_t i = 0; planes && i < planes->size(); ++i)
      require((*planes)[i].image.pixel.size() == (*planes)[i].geometry.pixels(), "a model has the pixels that it says");
  }
}

/// What can be read can be written, and read again to the same bits.
void require_written_again(const InputFile& file) {
  const auto planes = read_or_refused(file.path(), [&] { return imager::read_stokes_images(file.path()); });
  if (!planes) return;
  const std::string again = (file.folder() / "again.fits").string();
  imager::write_fits(*planes, again, imager::PixelFormat::float64);
  const std::vector<imager::SkyImage> reread = imager::read_stokes_images(again);
  require(reread.size() == planes->size(), "an image that was written has as many planes");
  for (std::size_t s = 0; s < reread.size(); ++s)
    for (std::size_t i = 0; i < reread[s].image.pixel.size(); ++i) {
      const double was = (*planes)[s].image.pixel[i], is = reread[s].image.pixel[i];
      require(was == is || (std::isnan(was) && std::isnan(is)), "an image that was written has the same pixels");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const InputFile file(data, size, "a.fits");
  require_mask(file.path());
  require_models(file.path());
  read_or_refused(file.path(), [&] { return tools::read_stokes_model(*tools::open_image_file(file.path()), file.path()); });
  require_written_again(file);
  return 0;
}
