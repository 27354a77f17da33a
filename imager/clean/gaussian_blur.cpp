#include "imager/clean/gaussian_blur.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "imager/numerics/fft.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

/// Convolves lines of so many pixels with taps.
class LineBlur {
 public:
  LineBlur(int pixels, const std::vector<double>& taps)
      : pixels_(pixels), length_(fast_fft_size(pixels + static_cast<int>(taps.size()) - 1)), fft_(length_) {
    const auto line = fft_.real_buffer();
    const auto spectrum = fft_.complex_buffer();
    std::fill_n(line.get(), length_, 0.0);
    const auto longest = std::min<std::size_t>(taps.size(), static_cast<std::size_t>(pixels));
    for (std::size_t k = 0; k < longest; ++k) {  // the others reach from no pixel to another
      line[k] = taps[k];
      if (k > 0) line[static_cast<std::size_t>(length_) - k] = taps[k];
    }
    fft_.real_to_complex(line.get(), spectrum.get());
    for (int k = 0; k <= length_ / 2; ++k) transfer_.push_back(spectrum[static_cast<std::size_t>(k)].real() / length_);
  }

  /// The buffers of one thread.
  struct Line {
    Fft<double>::RealBuffer pixel;
    Fft<double>::ComplexBuffer spectrum;
  };
  Line line() const { return {fft_.real_buffer(), fft_.complex_buffer()}; }

  void operator()(const Line& line) const {
    std::fill(line.pixel.get() + pixels_, line.pixel.get() + length_, 0.0);
    fft_.real_to_complex(line.pixel.get(), line.spectrum.get());
    for (std::size_t k = 0; k < transfer_.size(); ++k) line.spectrum[k] *= transfer_[k];
    fft_.complex_to_real(line.spectrum.get(), line.pixel.get());
  }

 private:
  int pixels_;
  int length_;
  Fft<double> fft_;
  std::vector<double> transfer_;  ///< real, since the taps are even
};

void blur_rows(Image& image, const std::vector<double>& taps, int threads) {
  constexpr int together = 16;
  const LineBlur blur(image.width, taps);
  parallel_for(static_cast<std::size_t>((image.height + together - 1) / together), threads, [&](std::size_t piece) {
    const LineBlur::Line line = blur.line();
    const int first = static_cast<int>(piece) * together;
    for (int r = first; r < std::min(image.height, first + together); ++r) {
      std::transform(image.row(r), image.row(r) + image.width, line.pixel.get(),
                     [](double x) { return std::isnan(x) ? 0 : x; });
      blur(line);
      std::copy_n(line.pixel.get(), image.width, image.row(r));
    }
  });
}

/// As many columns at a time as share a cache line.
void blur_columns(Image& image, const std::vector<double>& taps, int threads) {
  constexpr int together = 8;
  const LineBlur blur(image.height, taps);
  parallel_for(static_cast<std::size_t>((image.width + together - 1) / together), threads, [&](std::size_t piece) {
    const int first = static_cast<int>(piece) * together, count = std::min(together, image.width - first);
    std::vector<LineBlur::Line> lines;
    for (int c = 0; c < count; ++c) lines.push_back(blur.line());
    for (int r = 0; r < image.height; ++r)
      for (int c = 0; c < count; ++c)
        lines[static_cast<std::size_t>(c)].pixel[static_cast<std::size_t>(r)] = image.at(r, first + c);
    for (const LineBlur::Line& line : lines) blur(line);
    for (int r = 0; r < image.height; ++r)
      for (int c = 0; c < count; ++c)
        image.at(r, first + c) = lines[static_cast<std::size_t>(c)].pixel[static_cast<std::size_t>(r)];
  });
}

}  // namespace

std::vector<double> gaussian_taps(double fwhm_pixels) {
  if (!(fwhm_pixels > 0))
    throw std::invalid_argument("a Gaussian of " + std::to_string(fwhm_pixels) + " pixels: expected a width above 0");
  constexpr double cut = 1e-9;
  const double rate = 4 * std::log(2.0) / (fwhm_pixels * fwhm_pixels);
  const auto reach = static_cast<std::size_t>(std::ceil(std::sqrt(-std::log(cut) / rate)));
  std::vector<double> taps(reach + 1);
  double sum = -1;
  for (std::size_t k = 0; k < taps.size(); ++k) {
    taps[k] = std::exp(-rate * static_cast<double>(k * k));
    sum += 2 * taps[k];
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

Image gaussian_blur(const Image& image, double fwhm_pixels, int threads) {
  const std::vector<double> taps = gaussian_taps(fwhm_pixels);
  Image result = image;
  blur_rows(result, taps, threads);
  blur_columns(result, taps, threads);
  return result;
}

}  // namespace misfit::imager
