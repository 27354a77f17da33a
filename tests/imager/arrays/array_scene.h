#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <random>
#include <vector>

#include "imager/arrays/array_transform.h"
#include "imager/numerics/constants.h"

namespace misfit::imager::testing {

/// Random samples that fill |u|, |v| < reach/(2 pixel) of an image, in arrays of this scene's own.
template <typename Real>
struct ArrayScene {
  ArrayImage image;
  std::vector<double> uvw_m, frequency_hz;
  std::vector<std::uint8_t> mask;
  std::vector<std::complex<Real>> visibility;
  std::vector<Real> weight;

  ArrayScene(const ArrayImage& of, std::size_t rows, std::size_t channels, double reach = 1) : image(of) {
    std::mt19937_64 random(rows + 31 * channels);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (std::size_t c = 0; c < channels; ++c) frequency_hz.push_back(1e9 * (1 + 0.2 * static_cast<double>(c)));
    const double edge_m = reach / 2 * speed_of_light_m_s / frequency_hz.back();
    for (std::size_t row = 0; row < rows; ++row)
      for (const double pixel : {image.pixel_x_rad, image.pixel_y_rad, image.pixel_x_rad})
        uvw_m.push_back(edge_m / pixel * uniform(random));
    for (std::size_t i = 0; i < rows * channels; ++i) {
      visibility.emplace_back(static_cast<Real>(uniform(random)), static_cast<Real>(uniform(random)));
      weight.push_back(static_cast<Real>(1 + uniform(random) / 2));
      mask.push_back(i % 7 == 3 ? 0 : 1);
    }
  }

  std::size_t rows() const { return uvw_m.size() / 3; }
  std::size_t channels() const { return frequency_hz.size(); }
  template <typename T>
  Strided<const T> table(const std::vector<T>& of) const {
    return {of.data(), rows(), channels(), static_cast<std::ptrdiff_t>(channels())};
  }
  ArrayCoordinates at(bool with_w = true) const {
    ArrayCoordinates at;
    at.uvw_m = {uvw_m.data(), rows(), 3, 3};
    at.frequency_hz = frequency_hz;
    at.mask = table(mask);
    at.w_sign = with_w ? 1 : 0;
    return at;
  }
  ArrayValues<Real> values() const { return {table(visibility), table(weight)}; }
  ArrayTransformOptions options(double accuracy) const {
    ArrayTransformOptions o;
    o.image = image;
    o.accuracy = accuracy;
    o.threads = 2;
    return o;
  }
};

/// Turns that a sample's phase has at a pixel, u x + v y − w(n − 1), as ArrayCoordinates says; and n, 0 beyond the horizon.
struct ArrayPhase {
  std::array<double, 3> to_pixel{};
  double n = 1;

  ArrayPhase(const ArrayImage& image, int i, int j, const ArrayCoordinates& at) {
    const double x = image.centre_x + (i - image.pixels_x / 2) * image.pixel_x_rad;
    const double y = image.centre_y + (j - image.pixels_y / 2) * image.pixel_y_rad;
    const double r2 = x * x + y * y;
    to_pixel = {at.u_sign * x, at.v_sign * y, 0};
    if (at.w_sign == 0) return;
    n = r2 <= 1 ? std::sqrt(1 - r2) : 0;
    to_pixel[2] = r2 <= 1 ? at.w_sign * r2 / (1 + n) : 0;
  }
  std::complex<double> phasor(const ArrayCoordinates& at, std::size_t row, std::size_t channel, double sign) const {
    double turns = 0;
    for (std::size_t k = 0; k < 3; ++k) turns += to_pixel[k] * at.uvw_m.at(row, k);
    return std::polar(1.0, sign * 2 * pi * turns * at.frequency_hz[channel] / speed_of_light_m_s);
  }
};

/// ArrayAdjoint's sum, divided by n where asked.
template <typename Real>
std::vector<double> direct_image(const ArrayImage& image, const ArrayCoordinates& at, const ArrayValues<Real>& values,
                                 bool divide_by_n) {
  std::vector<double> pixels;
  for (int i = 0; i < image.pixels_x; ++i)
    for (int j = 0; j < image.pixels_y; ++j) {
      const ArrayPhase phase(image, i, j, at);
      double sum = 0;
      for (std::size_t row = 0; phase.n > 0 && row < at.rows(); ++row)
        for (std::size_t channel = 0; channel < at.channels(); ++channel) {
          if (at.mask && at.mask.at(row, channel) == 0) continue;
          const std::complex<double> v(values.visibility.at(row, channel));
          const double weight = values.weight ? double{values.weight.at(row, channel)} : 1;
          sum += weight * (v * phase.phasor(at, row, channel, 1)).real();
        }
      pixels.push_back(phase.n > 0 && divide_by_n ? sum / phase.n : sum);
    }
  return pixels;
}

/// ArrayCoordinates' equation, of a model [x][y].
template <typename Real>
std::vector<std::complex<double>> direct_visibilities(const ArrayImage& image, const ArrayCoordinates& at,
                                                      const std::vector<Real>& model, bool divide_by_n) {
  std::vector<std::complex<double>> visibility(at.samples());
  for (int i = 0; i < image.pixels_x; ++i)
    for (int j = 0; j < image.pixels_y; ++j) {
      const ArrayPhase phase(image, i, j, at);
      if (!(phase.n > 0)) continue;
      const double flux = double{model[static_cast<std::size_t>(i * image.pixels_y + j)]} / (divide_by_n ? phase.n : 1);
      if (flux == 0) continue;
      for (std::size_t row = 0; row < at.rows(); ++row)
        for (std::size_t channel = 0; channel < at.channels(); ++channel)
          if (!at.mask || at.mask.at(row, channel) != 0)
            visibility[row * at.channels() + channel] += flux * phase.phasor(at, row, channel, -1);
    }
  return visibility;
}

}  // namespace misfit::imager::testing
