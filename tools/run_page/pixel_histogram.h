#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "imager/data/image.h"
#include "tools/report/figure.h"

namespace misfit::tools {

/// How an image's pixels that are not NaN are spread, in units of its noise σ.
struct PixelHistogram {
  double noise_jy = 0;  ///< σ; 0: there is none, and nothing is counted
  double min_jy = 0;
  double max_jy = 0;
  std::uint64_t pixels = 0;
  std::uint64_t beyond_5_sigma = 0;
  double step_sigma = 0;             ///< width of a bin
  std::vector<std::uint64_t> count;  ///< as many bins to either side of 0; they cover the pixels, or ±10 σ where that is less
};
PixelHistogram pixel_histogram(const imager::Image& image, double noise_jy, int threads);

/// {noise_jy, min_jy, max_jy, pixels, beyond_5_sigma, step_sigma, counts}; null without noise.
nlohmann::json histogram_json(const PixelHistogram& histogram);

/// The bins, and the Gaussian of that noise about 0 over as many pixels. For a histogram that counted something.
Figure histogram_figure(const PixelHistogram& histogram);

}  // namespace misfit::tools
