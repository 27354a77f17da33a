#pragma once

#include <cmath>
#include <functional>
#include <random>

#include "imager/taylor/taylor_expansion.h"
#include "tests/imager/vla_samples.h"

namespace misfit::imager::testing {

/// A source whose flux density in Jy depends on the frequency in Hz.
struct SpectralSource {
  DirectionCosines position;
  std::function<double(double)> flux_jy;
};

/// flux (ν/ν_0)^alpha.
inline std::function<double(double)> power_law(double flux_jy, double alpha, double reference_hz) {
  return [=](double frequency_hz) { return flux_jy * std::pow(frequency_hz / reference_hz, alpha); };
}

/// vla_samples in so many channels, evenly over `fraction` of 4 GHz about it.
inline VisibilityBlock wide_band_samples(int hour_angles, int channels, double fraction, double arm_m = 21000) {
  VisibilityBlock block = vla_samples(hour_angles, arm_m);
  block.frequency_hz.clear();
  for (int c = 0; c < channels; ++c)
    block.frequency_hz.push_back(4e9 * (1 + fraction * (channels == 1 ? 0 : double(c) / (channels - 1) - 0.5)));
  block.weight.assign(block.samples(), 1);
  block.visibility.assign(block.samples(), 0);
  return block;
}

/// Gives the block the visibilities of the sources, and normal noise in real and imaginary parts.
inline void observe(const std::vector<SpectralSource>& sources, double noise_jy, unsigned seed, VisibilityBlock& block) {
  std::vector<std::complex<double>> sum(block.samples());
  for (const SpectralSource& source : sources) {
    const auto unit = predict_sources({{source.position, 1}}, block, 2);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += source.flux_jy(block.frequency_hz[i % block.channels()]) * unit[i];
  }
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  for (std::size_t i = 0; noise_jy > 0 && i < sum.size(); ++i) {
    const double real = normal(random), imaginary = normal(random);
    sum[i] += noise_jy * std::complex<double>(real, imaginary);
  }
  block.visibility.assign(sum.begin(), sum.end());
}

}  // namespace misfit::imager::testing
