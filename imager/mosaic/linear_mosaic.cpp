#include "imager/mosaic/linear_mosaic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "imager/numerics/parallel.h"

namespace misfit::imager {

void LinearMosaic::add(const MosaicPart& part, int threads) {
  if (!(part.noise_jy > 0))
    throw std::invalid_argument("a noise of " + std::to_string(part.noise_jy) + " Jy/beam; expected more than 0");
  for (const Image* image : {&part.apparent, &part.beam})
    if (image->width != sum_.width || image->height != sum_.height)
      throw std::invalid_argument("a plane of " + std::to_string(image->width) + " × " + std::to_string(image->height) +
                                  " pixels; expected the mosaic's " + std::to_string(sum_.width) + " × " +
                                  std::to_string(sum_.height));
  const double per_square = 1 / (part.noise_jy * part.noise_jy);
  parallel_for(static_cast<std::size_t>(sum_.height), threads, [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int c = 0; c < sum_.width; ++c) {
      const double beam = part.beam.at(r, c), apparent = part.apparent.at(r, c);
      if (!(beam >= least_beam) || std::isnan(apparent)) continue;
      sum_.at(r, c) += beam * apparent * per_square;
      weight_.at(r, c) += beam * beam * per_square;
    }
  });
}

MosaicPlane LinearMosaic::finished(double limit) const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const double most = weight_.pixel.empty() ? 0 : *std::max_element(weight_.pixel.begin(), weight_.pixel.end());
  MosaicPlane plane{sum_, weight_, weight_, weight_};
  for (std::size_t i = 0; i < weight_.pixel.size(); ++i) {
    const double weight = weight_.pixel[i], beam = std::sqrt(weight / most);
    const bool defined = weight > 0 && beam >= limit;
    plane.sky.pixel[i] = defined ? sum_.pixel[i] / weight : none;
    plane.weight.pixel[i] = defined ? weight : none;
    plane.noise.pixel[i] = defined ? 1 / std::sqrt(weight) : none;
    plane.beam.pixel[i] = defined ? beam : none;
  }
  return plane;
}

}  // namespace misfit::imager
