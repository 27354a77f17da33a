#include "tools/stability/extended_sums.h"

#include <cmath>
#include <numbers>

#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"
#include "imager/transform/sampling.h"

namespace misfit::tools {
namespace {

using Extended = long double;

struct ExtendedPosition {
  Extended l = 0;
  Extended m = 0;
  Extended n_minus_1 = 0;

  explicit ExtendedPosition(imager::DirectionCosines at) : l(at.l), m(at.m) {
    const Extended r2 = l * l + m * m;
    n_minus_1 = -r2 / (1 + std::sqrt(1 - r2));
  }
};

/// exp(2πi(ul+vm+w(n−1))).
std::complex<Extended> phasor(const double* uvw_m, double frequency_hz, const ExtendedPosition& to) {
  const Extended turns = (uvw_m[0] * to.l + uvw_m[1] * to.m + uvw_m[2] * to.n_minus_1) * frequency_hz /
                         static_cast<Extended>(imager::speed_of_light_m_s);
  return std::polar(Extended{1}, 2 * std::numbers::pi_v<Extended> * (turns - std::round(turns)));
}

}  // namespace

std::vector<double> extended_pixels(const imager::VisibilityBlock& block, const imager::ImageGeometry& geometry,
                                    const std::vector<imager::Pixel>& pixels) {
  imager::SampleSums unused;
  const std::vector<float> weight = imager::imaging_weights(block, {geometry}, unused);
  Extended weights = 0;
  for (const float w : weight) weights += Extended{w};
  std::vector<double> image(pixels.size());
  imager::parallel_for(pixels.size(), imager::available_threads(), [&](std::size_t k) {
    const ExtendedPosition to(geometry.at(pixels[k].row, pixels[k].column));
    Extended sum = 0;
    for (std::size_t i = 0; i < weight.size(); ++i) {
      if (weight[i] == 0) continue;
      const std::complex<Extended> turn =
          phasor(&block.uvw_m[3 * (i / block.channels())], block.frequency_hz[i % block.channels()], to);
      const std::complex<Extended> v(block.visibility[i].real(), block.visibility[i].imag());
      sum += Extended{weight[i]} * (v.real() * turn.real() + v.imag() * turn.imag());
    }
    image[k] = static_cast<double>(sum / weights);
  });
  return image;
}

std::vector<std::complex<double>> extended_visibilities(const imager::SampleCoordinates& at,
                                                        const imager::ImageGeometry& geometry, const imager::Image& model) {
  std::vector<std::complex<double>> visibility(at.samples());
  imager::parallel_for(visibility.size(), imager::available_threads(), [&](std::size_t i) {
    std::complex<Extended> sum = 0;
    for (int row = 0; row < model.height; ++row)
      for (int column = 0; column < model.width; ++column)
        if (model.at(row, column) != 0)
          sum +=
              Extended{model.at(row, column)} * phasor(&at.uvw_m[3 * (i / at.channels())], at.frequency_hz[i % at.channels()],
                                                       ExtendedPosition(geometry.at(row, column)));
    visibility[i] = std::complex<double>(sum);
  });
  return visibility;
}

}  // namespace misfit::tools
