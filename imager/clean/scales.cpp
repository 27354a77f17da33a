#include "imager/clean/scales.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "imager/clean/bright_loops.h"

namespace misfit::imager {

void check_scales(const MultiscaleOptions& o) {
  if (o.scale_pixels.empty()) throw std::invalid_argument("no scales: expected one at least");
  for (std::size_t s = 0; s < o.scale_pixels.size(); ++s) {
    const double scale = o.scale_pixels[s];
    if (!(std::isfinite(scale) && scale >= 0) || (s > 0 && !(scale > o.scale_pixels[s - 1])))
      throw std::invalid_argument("scale " + std::to_string(scale) + ": expected ascending numbers of pixels, 0 or more");
  }
  if (!(o.small_scale_bias >= 0 && o.small_scale_bias < 1))
    throw std::invalid_argument("small-scale bias " + std::to_string(o.small_scale_bias) + ": expected 0 or more, and below 1");
}

std::vector<LookedAt> scales_looked_at(const MultiscaleOptions& options) {
  std::vector<LookedAt> result{LookedAt{}};
  const double largest = options.scale_pixels.back();
  for (std::size_t s = 0; s < options.scale_pixels.size(); ++s) {
    LookedAt scale{options.scale_pixels[s], static_cast<int>(s), 1, 1};
    if (largest > 0) scale.bias = 1 - options.small_scale_bias * scale.pixels / largest;
    while (10 * scale.step <= scale.pixels && 2 * scale.step <= bright_tile_side) scale.step *= 2;
    if (scale.pixels == 0)
      result.front() = scale;
    else
      result.push_back(scale);
  }
  return result;
}

}  // namespace misfit::imager
