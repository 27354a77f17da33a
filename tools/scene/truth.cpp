#include "tools/scene/truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "imager/data/horizon.h"
#include "imager/data/noise.h"
#include "imager/numerics/stage_times.h"
#include "imager/transform/sampling.h"

namespace misfit::tools {
namespace {

constexpr int model_pixels = 60;
constexpr std::size_t samples_a_block = 400;  ///< at which predictions are compared

/// Sums over some squared differences.
struct Tally {
  double square = 0;
  double fourth = 0;
  double largest = 0;
  double count = 0;

  void add(double squared) {
    square += squared;
    fourth += squared * squared;
    largest = std::max(largest, squared);
    ++count;
  }
  double mean_square() const { return square / std::max(count, 1.0); }
  /// Variance of mean_square().
  double variance() const {
    return std::max(0.0, fourth / std::max(count, 1.0) - mean_square() * mean_square()) / std::max(count - 1, 1.0);
  }
};

/// Relative standard error of a root: half the relative error of its square.
double noise_of_root(double square, double variance) {
  return square > 0 ? std::sqrt(variance) / square / 2 : 0;
}

/// Where a row or column lies along its side: 0 within a sixteenth of an end, 2 in the inner half, else 1.
int depth(int at, int size) {
  const int from_end = std::min(at, size - 1 - at);
  return 16 * from_end < size ? 0 : 4 * from_end + 2 < size ? 1 : 2;
}

}  // namespace

SceneErrors SceneErrors::none() {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  return {nan, nan, nan, nan, nan, nan, nan, nan, nan, nan};
}

SceneTruth::SceneTruth(const imager::VisibilitySource& source, const imager::ImageGeometry& geometry, int pixels, int threads,
                       const imager::Progress& progress)
    : geometry_(geometry), model_(geometry.width, geometry.height) {
  choose_pixels(pixels);
  std::mt19937_64 random(20200113);
  for (std::size_t k = 0; k < pixel_.size() && k < model_pixels; ++k)
    model_.at(pixel_[k].at.row, pixel_[k].at.column) = random() % 2 == 0 ? 1 : -1;

  imager::DirectPixels at{geometry, {}, true, threads};
  for (const ChosenPixel& chosen : pixel_) at.pixel.push_back(chosen.at);
  const auto predict = imager::DirectTransform(geometry, threads).predict(model_);
  std::vector<std::vector<double>> direct(1, std::vector<double>(pixel_.size()));
  double weight = 0, seconds = 0;
  imager::SampleSums sums;
  std::uint64_t done = 0;
  std::size_t index = 0;
  const auto stream = source.open();
  for (auto block = stream->next(); block; block = stream->next(), ++index) {
    const imager::Stopwatch watch;
    imager::add_direct_pixels(*block, at, direct);
    seconds += watch.seconds();
    for (const float w : imager::imaging_weights(*block, {geometry, false, threads}, sums)) weight += double{w};
    imager::SampleCoordinates one{{}, {0}};
    for (std::size_t i = 0; i < samples_a_block; ++i) {
      const std::size_t sample = random() % block->samples();
      if (block->weight[sample] == 0) continue;
      const double* uvw_m = &block->uvw_m[3 * (sample / block->channels())];
      one.uvw_m.edit().assign(uvw_m, uvw_m + 3);
      one.frequency_hz.front() = block->frequency_hz[sample % block->channels()];
      samples_.push_back({index, sample, predict->at(one).front()});
      visibility_square_ += std::norm(samples_.back().visibility);
    }
    counts_ += block->counts;
    done += block->samples();
    progress(done, source.samples());
  }
  direct_ = std::move(direct.front());
  counts_.outside_grid = sums.outside_grid;
  counts_.used = sums.used;
  if (counts_.used == 0) throw imager::NothingUsable(counts_);
  for (double& pixel : direct_) pixel /= weight;
  seconds_a_pixel_ = seconds / static_cast<double>(std::max<std::size_t>(pixel_.size(), 1));
}

void SceneTruth::choose_pixels(int count) {
  std::mt19937_64 random(20200112);
  const int width = geometry_.width, height = geometry_.height;
  const auto place_at = [&](int row, int column) { return Place{border - std::min(depth(row, height), depth(column, width))}; };
  const auto offer = [&](int row, int column, double share) {
    if (imager::beyond_horizon(geometry_.at(row, column))) return;
    pixel_.push_back({{row, column}, place_at(row, column), share});
  };
  for (const int row : {0, height - 1})
    for (const int column : {0, width - 1}) offer(row, column, 0);
  double area[places]{};
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) ++area[place_at(row, column)];
  int wanted[places];
  for (int place = 0; place < places; ++place) wanted[place] = area[place] > 0 ? count : 0;
  while (std::any_of(wanted, wanted + places, [](int n) { return n > 0; })) {
    const auto row = static_cast<int>(random() % static_cast<std::uint64_t>(height));
    const auto column = static_cast<int>(random() % static_cast<std::uint64_t>(width));
    const Place place = place_at(row, column);
    if (wanted[place]-- > 0) offer(row, column, area[place] / count);
  }
}

SceneErrors SceneTruth::errors_of(const imager::Image& dirty) const {
  Tally tally[places];
  double share[places]{}, largest = 0;
  for (std::size_t k = 0; k < pixel_.size(); ++k) {
    const auto& [at, place, part] = pixel_[k];
    const double difference = dirty.at(at.row, at.column) - direct_[k];
    largest = std::max(largest, std::abs(difference));
    tally[place].largest = std::max(tally[place].largest, difference * difference);
    if (part == 0) continue;
    tally[place].add(difference * difference);
    share[place] += part;
  }
  const double whole = std::accumulate(share, share + places, 0.0);
  double square = 0, variance = 0;
  for (int place = 0; place < places; ++place) {
    const double part = share[place] / whole;
    square += part * tally[place].mean_square();
    variance += part * part * tally[place].variance();
  }
  const double image_rms = imager::root_mean_square(dirty);
  SceneErrors errors = SceneErrors::none();
  errors.rms = std::sqrt(square) / image_rms;
  errors.rms_noise = noise_of_root(square, variance);
  errors.max = largest / image_rms;
  errors.centre_rms = std::sqrt(tally[centre].mean_square()) / image_rms;
  errors.centre_max = std::sqrt(tally[centre].largest) / image_rms;
  errors.border_rms = std::sqrt(tally[border].mean_square()) / image_rms;
  errors.border_max = std::sqrt(tally[border].largest) / image_rms;
  return errors;
}

void SceneTruth::compare(std::size_t block, const std::vector<std::complex<double>>& predicted, SceneErrors& errors) const {
  if (block == 0) errors.predict_rms = errors.predict_noise = errors.predict_max = 0;
  for (const ChosenSample& chosen : samples_) {
    if (chosen.block != block) continue;
    const double square = std::norm(predicted[chosen.sample] - chosen.visibility);
    errors.predict_rms += square;
    errors.predict_noise += square * square;
    errors.predict_max = std::max(errors.predict_max, square);
  }
}

void SceneTruth::finish(SceneErrors& errors) const {
  const Tally tally{errors.predict_rms, errors.predict_noise, errors.predict_max, static_cast<double>(samples_.size())};
  errors.predict_rms = std::sqrt(tally.square / visibility_square_);
  errors.predict_noise = noise_of_root(tally.mean_square(), tally.variance());
  errors.predict_max = std::sqrt(tally.largest / (visibility_square_ / tally.count));
}

}  // namespace misfit::tools
