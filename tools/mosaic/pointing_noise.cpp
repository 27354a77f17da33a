#include "tools/mosaic/pointing_noise.h"

#include <stdexcept>

#include "imager/data/noise.h"
#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

/// A doubt about the residual's noise: CLEAN that goes on into the noise takes it out of the residual, and leaves it in the
/// image.
std::string cleaned_noise_doubt(const PointingImage& image, double residual_jy, double image_jy) {
  constexpr double much = 1.2;
  if (!(image_jy > much * residual_jy)) return "";
  return image.residual_path() + " has a noise of " + with_prefix(residual_jy, "Jy/beam", 3) + ", and " + image.path() +
         " has one of " + with_prefix(image_jy, "Jy/beam", 3) +
         ": CLEAN may have taken noise out of the residual, or sources fill the image; --rms sets the noise to be used";
}

}  // namespace

PlaneNoise noise_of_plane(const PointingImage& image, const imager::PlaneIndex& at, const imager::Image& shown,
                          const NoiseRequest& request) {
  if (request.given_jy && !request.change) return {*request.given_jy};
  const bool residual = !image.residual_path().empty();
  imager::Image noise = residual ? image.read_residual(at) : shown;
  const double before_jy = imager::robust_noise(noise, request.threads);
  double after_jy = before_jy;
  if (request.change) {
    noise = imager::with_beam(noise, *request.change, residual ? image.residual_grid() : image.grid(), request.threads);
    after_jy = imager::robust_noise(noise, request.threads);
  }
  if (request.given_jy) return {*request.given_jy * (before_jy > 0 && after_jy > 0 ? after_jy / before_jy : 1)};
  if (!(after_jy > 0))
    throw std::runtime_error((residual ? image.residual_path() : image.path()) + " has a noise of " +
                             with_prefix(after_jy, "Jy/beam", 3) + " in plane " + plane_words(image, at) +
                             "; expected more than 0, or --rms");
  return {after_jy, residual ? cleaned_noise_doubt(image, before_jy, imager::robust_noise(shown, request.threads)) : ""};
}

std::string plane_words(const PointingImage& image, const imager::PlaneIndex& at) {
  return std::to_string(at.channel) + " of Stokes " + stokes_name(image.header().stokes[static_cast<std::size_t>(at.stokes)]);
}

}  // namespace misfit::tools
