#include "imager/verify.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "imager/noise.h"

namespace misfit::imager {
namespace {

/// Indices of samples in ascending order, so that one pass finds them.
std::vector<std::uint64_t> random_samples(std::uint64_t samples, int count, std::mt19937_64& random) {
  std::vector<std::uint64_t> chosen;
  for (int i = 0; i < count; ++i) chosen.push_back(random() % samples);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// Adds the coordinates of the chosen samples that lie in `block`, whose first sample has index `first`, one row and channel
/// each.
void collect(const VisibilityBlock& block, std::uint64_t first, const std::vector<std::uint64_t>& chosen,
             std::vector<SampleCoordinates>& found) {
  for (auto i = std::lower_bound(chosen.begin(), chosen.end(), first); i != chosen.end() && *i < first + block.samples(); ++i) {
    const std::size_t row = (*i - first) / block.channels();
    SampleCoordinates one;
    one.uvw_m.assign(block.uvw_m.begin() + static_cast<std::ptrdiff_t>(3 * row),
                     block.uvw_m.begin() + static_cast<std::ptrdiff_t>(3 * row + 3));
    one.frequency_hz = {block.frequency_hz[(*i - first) % block.channels()]};
    if (std::all_of(one.uvw_m.begin(), one.uvw_m.end(), [](double x) { return std::isfinite(x); })) found.push_back(one);
  }
}

}  // namespace

std::vector<Pixel> random_pixels(const ImageGeometry& geometry, int count) {
  std::mt19937_64 random(20200112);
  const auto width = static_cast<std::uint64_t>(geometry.width);
  std::vector<Pixel> pixels;
  for (int i = 0; i < count; ++i) {
    const std::uint64_t at = random() % geometry.pixels();
    pixels.push_back({static_cast<int>(at / width), static_cast<int>(at % width)});
  }
  return pixels;
}

PixelError pixel_error(const Image& dirty, const std::vector<Pixel>& pixels, const std::vector<double>& direct_sums,
                       double weight) {
  PixelError error;
  double square = 0;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const double difference = dirty.at(pixels[k].row, pixels[k].column) - direct_sums[k] / weight;
    square += difference * difference;
    error.max = std::max(error.max, std::abs(difference));
  }
  error.rms = std::sqrt(square / static_cast<double>(std::max<std::size_t>(pixels.size(), 1)));
  return error;
}

MeasuredError measure_error(const VisibilitySource& source, const Transform& transform, const ImageGeometry& geometry,
                            const DirtyImages& images, int count, int threads, const Progress& progress) {
  std::mt19937_64 random(20200112);
  const std::vector<Pixel> pixels = random_pixels(geometry, count);
  const DirectPixels direct_pixels{geometry, pixels, true, threads};
  const std::vector<std::uint64_t> chosen = random_samples(source.samples(), count, random);

  std::vector<double> sum(pixels.size());
  std::vector<SampleCoordinates> samples;
  std::uint64_t done = 0;
  const auto stream = source.open();
  while (const auto block = stream->next()) {
    add_direct_pixels(*block, direct_pixels, sum);
    collect(*block, done, chosen, samples);
    done += block->samples();
    progress(done, source.samples());
  }

  const double image_rms = root_mean_square(images.dirty);
  const PixelError of_pixels = pixel_error(images.dirty, pixels, sum, images.sums.weight);
  MeasuredError error{of_pixels.rms / image_rms, of_pixels.max / image_rms, 0};

  Image model(geometry.width, geometry.height);
  for (const Pixel& pixel : pixels) model.at(pixel.row, pixel.column) = random() % 2 == 0 ? 1 : -1;
  const auto gridded = transform.predict(model);
  const auto direct = DirectTransform(geometry, threads).predict(model);
  double difference = 0;
  double size = 0;
  for (const SampleCoordinates& sample : samples) {
    const std::complex<double> exact = direct->at(sample)[0];
    difference += std::norm(gridded->at(sample)[0] - exact);
    size += std::norm(exact);
  }
  error.predict_rms = size == 0 ? 0 : std::sqrt(difference / size);
  return error;
}

}  // namespace misfit::imager
