#include "tools/run_page/pixel_histogram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>

#include "imager/numerics/parallel.h"
#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

constexpr int bins_a_sigma = 5;
constexpr int most_sigma = 10;
constexpr int least_sigma = 5;
constexpr int half = bins_a_sigma * most_sigma;  ///< bins to either side of 0

constexpr std::size_t bins = 2 * half + 2;  ///< the outermost two are for pixels beyond

/// The counts of some of the pixels; NaN does not count.
struct Tally {
  double min = HUGE_VAL;
  double max = -HUGE_VAL;
  std::array<std::uint64_t, bins> count{};

  /// In lanes, so that no pixel waits for the one before.
  void add(const double* pixel, std::size_t pixels, double bins_a_jy) {
    constexpr std::size_t lanes = 8;
    double low[lanes], high[lanes];
    std::uint32_t counted[lanes][bins] = {}, absent[lanes] = {};  // absent pixels lie in the first bin
    std::fill_n(low, lanes, min);
    std::fill_n(high, lanes, max);
    const auto add_one = [&](double value, std::size_t lane) {
      low[lane] = value < low[lane] ? value : low[lane];
      high[lane] = value > high[lane] ? value : high[lane];
      absent[lane] += value != value ? 1 : 0;
      const double above = value * bins_a_jy + (half + 1);
      const double positive = above > 0 ? above : 0;
      ++counted[lane][static_cast<int>(positive < bins - 1 ? positive : bins - 1)];
    };
    const std::size_t whole = pixels / lanes * lanes;
    for (std::size_t i = 0; i < whole; i += lanes)
      for (std::size_t lane = 0; lane < lanes; ++lane) add_one(pixel[i + lane], lane);
    for (std::size_t i = whole; i < pixels; ++i) add_one(pixel[i], 0);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      for (std::size_t b = 0; b < bins; ++b) count[b] += counted[lane][b];
      count.front() -= absent[lane];
    }
    min = *std::min_element(low, low + lanes);
    max = *std::max_element(high, high + lanes);
  }
  void join(const Tally& other) {
    min = std::min(min, other.min);
    max = std::max(max, other.max);
    for (std::size_t b = 0; b < bins; ++b) count[b] += other.count[b];
  }
};

Tally tally_of(const imager::Image& image, double bins_a_jy, int threads) {
  constexpr std::size_t chunk_pixels = std::size_t{1} << 16;
  std::vector<Tally> part((image.pixel.size() + chunk_pixels - 1) / chunk_pixels);
  imager::parallel_for(part.size(), threads, [&](std::size_t k) {
    const std::size_t first = k * chunk_pixels;
    part[k].add(&image.pixel[first], std::min(chunk_pixels, image.pixel.size() - first), bins_a_jy);
  });
  Tally all;
  for (const Tally& some : part) all.join(some);
  return all;
}

}  // namespace

PixelHistogram pixel_histogram(const imager::Image& image, double noise_jy, int threads) {
  if (!(noise_jy > 0)) return {};
  const Tally tally = tally_of(image, bins_a_sigma / noise_jy, threads);
  PixelHistogram made;
  made.noise_jy = noise_jy;
  made.min_jy = tally.min;
  made.max_jy = tally.max;
  made.step_sigma = 1.0 / bins_a_sigma;
  const double reach = std::floor(std::max(tally.max, -tally.min) / noise_jy) + 1;
  const auto shown = static_cast<std::ptrdiff_t>(bins_a_sigma * std::clamp<double>(reach, least_sigma, most_sigma));
  const auto middle = tally.count.begin() + half + 1;
  constexpr std::ptrdiff_t near = 5 * bins_a_sigma;
  made.pixels = std::accumulate(tally.count.begin(), tally.count.end(), std::uint64_t{0});
  made.beyond_5_sigma = made.pixels - std::accumulate(middle - near, middle + near, std::uint64_t{0});
  made.count.assign(middle - shown, middle + shown);
  return made;
}

nlohmann::json histogram_json(const PixelHistogram& h) {
  if (h.pixels == 0) return nullptr;
  return {{"noise_jy", h.noise_jy},
          {"min_jy", h.min_jy},
          {"max_jy", h.max_jy},
          {"pixels", h.pixels},
          {"beyond_5_sigma", h.beyond_5_sigma},
          {"step_sigma", h.step_sigma},
          {"counts", h.count}};
}

Figure histogram_figure(const PixelHistogram& h) {
  const double reach = h.step_sigma * static_cast<double>(h.count.size()) / 2;
  Figure figure{.name = "histogram",
                .title = "Histogram of pixels",
                .caption = "",
                .x = {.label = "pixel value / σ", .from = -reach, .to = reach},
                .y = {.label = "pixels a bin", .logarithmic = true, .from = 0.5},
                .series = {{.label = "pixels", .x = {}, .y = {}, .columns = true},
                           {.label = "Gaussian of the noise σ about 0", .x = {}, .y = {}, .law = true}},
                .width = 520,  // as wide as the curve of CLEAN
                .height = 400};
  Series& pixels = figure.series[0];
  Series& gaussian = figure.series[1];
  const double peak = static_cast<double>(h.pixels) * h.step_sigma / std::sqrt(2 * std::numbers::pi);
  for (std::size_t i = 0; i < h.count.size(); ++i) {
    pixels.x.push_back((static_cast<double>(i) + 0.5) * h.step_sigma - reach);
    pixels.y.push_back(static_cast<double>(h.count[i]));
    gaussian.x.push_back(pixels.x.back());
    gaussian.y.push_back(peak * std::exp(-0.5 * pixels.x.back() * pixels.x.back()));
  }
  return figure;
}

}  // namespace misfit::tools
