#pragma once

#include <optional>
#include <string>

#include "imager/mosaic/resolution.h"
#include "tools/mosaic/pointing_image.h"

namespace misfit::tools {

/// How the noise of a plane is to be found.
struct NoiseRequest {
  std::optional<double> given_jy;              ///< σ of the plane as it lies in the file, Jy/beam, from --rms
  std::optional<imager::BeamChange> change{};  ///< by which the plane is brought to another beam before it is added
  int threads = 1;
};

struct PlaneNoise {
  double noise_jy = 0;  ///< σ, Jy/beam, above 0
  std::string doubt{};  ///< a sentence where it may be wrong; mostly empty
};

/// The noise with which a plane of an image is added: the robust noise of the residual beside it, or else of the plane itself,
/// `shown`, measured after the change of the beam. A noise that is given changes by as much as the measured one does. Throws
/// std::runtime_error that names the file where nothing is given and the measured noise is not above 0.
PlaneNoise noise_of_plane(const PointingImage& image, const imager::PlaneIndex& at, const imager::Image& shown,
                          const NoiseRequest& request);

/// "0 of Stokes I".
std::string plane_words(const PointingImage& image, const imager::PlaneIndex& at);

}  // namespace misfit::tools
