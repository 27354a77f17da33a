#pragma once

#include "imager/plan/plan.h"
#include "ms_io/measurement_set.h"
#include "tools/run/time_forecast.h"

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

/// Of the images of a channel, as ranks send them.
double channel_bytes(const RunWork& work);

/// How the ranks share the channels of a cube, in batches of so many, of each of which rank 0 gets so many bytes.
imager::Decision channel_sharing_decision(int ranks, int channels, int channels_of_a_batch, double channel_bytes);

/// What they did exchange: of an image what rank 0 gave, which took so long; of channels what all gave.
imager::Decision traffic_decision(const imager::Traffic& traffic, double seconds);
imager::Decision channel_traffic_decision(const imager::Traffic& traffic);

}  // namespace misfit::tools
