#include "imager/direct/verify.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>

#include "imager/data/noise.h"

namespace misfit::imager {
namespace {

/// Indices of samples in ascending order, so that one pass finds them.
std::vector<std::uint64_t> random_samples(std::uint64_t samples, int count, std::mt19937_64& random) {
  std::vector<std::uint64_t> chosen;
  for (int i = 0; i < count; ++i) chosen.push_back(random() % std::max<std::uint64_t>(samples, 1));
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// Chosen samples, a row each, of each frequency.
using ChosenSamples = std::map<double, SampleCoordinates>;

/// Adds the coordinates of the chosen samples that lie in `block`, whose first sample has index `first`; of usable samples
/// alone: others may lie beyond what was planned for.
void collect(const VisibilityBlock& block, std::uint64_t first, const std::vector<std::uint64_t>& chosen,
             ChosenSamples& found) {
  for (auto i = std::lower_bound(chosen.begin(), chosen.end(), first); i != chosen.end() && *i < first + block.samples(); ++i) {
    const std::size_t row = (*i - first) / block.channels();
    const double* uvw_m = &block.uvw_m[3 * row];
    const double hz = block.frequency_hz[(*i - first) % block.channels()];
    if (block.weight[*i - first] == 0) continue;
    if (!std::all_of(uvw_m, uvw_m + 3, [](double x) { return std::isfinite(x); })) continue;
    SampleCoordinates& of_frequency = found.insert({hz, {{}, {hz}}}).first->second;
    of_frequency.uvw_m.append({uvw_m[0], uvw_m[1], uvw_m[2]});
    if (!block.sights.empty()) of_frequency.sights.push_back(block.sights[row]);
  }
}

/// The visibilities of sources for samples with this response.
std::vector<std::complex<double>> predict_response(const std::vector<Source>& sources, const SampleCoordinates& at,
                                                   const SampleResponse& response, int threads) {
  std::vector<DirectionCosines> directions;
  for (const Source& source : sources) directions.push_back(source.position);
  const BlockResponse seen = response.of(at, directions);
  std::vector<std::complex<double>> sum(at.samples());
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const auto one = predict_sources({sources[k]}, at, threads);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += seen.at(k, i) * one[i];
  }
  return sum;
}

std::vector<Pixel> all_pixels(const ImageGeometry& geometry) {
  std::vector<Pixel> pixels;
  for (int row = 0; row < geometry.height; ++row)
    for (int column = 0; column < geometry.width; ++column)
      if (!beyond_horizon(geometry.at(row, column))) pixels.push_back({row, column});
  return pixels;
}

}  // namespace

std::vector<Pixel> random_pixels(const ImageGeometry& geometry, int count) {
  if (count >= 0 && static_cast<std::size_t>(count) >= geometry.pixels()) return all_pixels(geometry);
  std::mt19937_64 random(20200112);
  const auto width = static_cast<std::uint64_t>(geometry.width);
  std::vector<Pixel> pixels;
  constexpr int tries_each = 1000;
  for (long long tries = 0; static_cast<int>(pixels.size()) < count && tries / tries_each < count; ++tries) {
    const std::uint64_t at = random() % geometry.pixels();
    const Pixel pixel{static_cast<int>(at / width), static_cast<int>(at % width)};
    if (!beyond_horizon(geometry.at(pixel.row, pixel.column))) pixels.push_back(pixel);
  }
  return pixels;
}

PixelError pixel_error(const Image& dirty, const std::vector<Pixel>& pixels, const std::vector<double>& direct_sums,
                       const Normalisation& by) {
  PixelError error;
  double square = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const double is = dirty.at(pixels[k].row, pixels[k].column);
    const double should = by.value(pixels[k].row, pixels[k].column, direct_sums[k]);
    if (std::isnan(is) && std::isnan(should)) continue;  // what no beam of a mosaic sees
    square += (is - should) * (is - should);
    error.max = std::max(error.max, std::abs(is - should));
    ++count;
  }
  error.rms = std::sqrt(square / static_cast<double>(std::max<std::size_t>(count, 1)));
  return error;
}

PixelError relative_pixel_error(const PixelError& error, const Image& dirty) {
  const double image_rms = root_mean_square(dirty);
  const auto relative = [image_rms](double x) { return x == 0 ? 0 : x / image_rms; };
  return {relative(error.rms), relative(error.max)};
}

MeasuredError measure_error(const VisibilitySource& source, const Transform& transform, const ImageGeometry& geometry,
                            const DirtyImages& images, int count, const Context& context,
                            std::shared_ptr<const SampleResponse> response) {
  std::mt19937_64 random(20200112);
  const Ranks& ranks = source.ranks();
  std::uint64_t all_samples = source.samples();
  sum_over(ranks, all_samples);
  const int predicted = static_cast<int>(std::min(std::uint64_t(count), all_samples));
  const std::vector<Pixel> pixels = random_pixels(geometry, count);
  const DirectPixels direct_pixels{geometry, pixels, true, context.threads, response};
  const std::vector<std::uint64_t> chosen = random_samples(source.samples(), predicted, random);

  std::vector<std::vector<double>> sum(images.dirty.size(), std::vector<double>(pixels.size()));
  ChosenSamples samples;
  std::uint64_t done = 0;
  const auto stream = source.open();
  while (const auto block = stream->next()) {
    add_direct_pixels(*block, direct_pixels, sum);
    collect(*block, done, chosen, samples);
    done += block->samples();
    context.tell(done, source.samples());
  }

  MeasuredError error;
  for (std::vector<double>& of_image : sum) ranks.sum_at_first(of_image.data(), of_image.size());
  for (std::size_t i = 0; ranks.first() && i < sum.size(); ++i)
    error.image.push_back(
        relative_pixel_error(pixel_error(images.dirty[i], pixels, sum[i], images.normalisation), images.dirty[i]));
  share_list(ranks, error.image);

  Image model(geometry.width, geometry.height);
  for (const Pixel& pixel : pixels) model.at(pixel.row, pixel.column) = random() % 2 == 0 ? 1 : -1;
  std::vector<Source> sources;
  for (int row = 0; row < model.height; ++row)
    for (int column = 0; column < model.width; ++column)
      if (model.at(row, column) != 0) sources.push_back({geometry.at(row, column), model.at(row, column)});
  const auto prediction = transform.predict(std::move(model));
  double difference = 0;
  double size = 0;
  for (const auto& [hz, at] : samples) {
    const auto direct =
        response ? predict_response(sources, at, *response, context.threads) : predict_sources(sources, at, context.threads);
    const auto gridded = prediction->at(at);
    for (std::size_t i = 0; i < direct.size(); ++i) {
      difference += std::norm(gridded[i] - direct[i]);
      size += std::norm(direct[i]);
    }
  }
  sum_over(ranks, difference, size);
  error.predict_rms = size == 0 ? 0 : std::sqrt(difference / size);
  return error;
}

}  // namespace misfit::imager
