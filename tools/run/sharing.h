#pragma once

#include "imager/plan/plan.h"
#include "ms_io/measurement_set.h"

namespace misfit::tools {

/// What ranks send each other of an image.
struct ExchangeForecast {
  double first_bytes = 0;  ///< a rank gives for the dirty images and the PSF
  double cycle_bytes = 0;  ///< and for the residuals of a major cycle
};

/// Of images of so many pixels: `images` with the PSF, and `residuals`.
ExchangeForecast exchange_of(double pixels, int images, int residuals);

/// How the ranks share the samples, and what they will exchange.
imager::Decision sharing_decision(const ms_io::SampleSharing& sharing, const ExchangeForecast& exchange);

/// What they did exchange.
imager::Decision traffic_decision(const imager::Traffic& traffic, double seconds);

}  // namespace misfit::tools
