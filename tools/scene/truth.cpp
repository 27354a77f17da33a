#include "tools/scene/truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "imager/horizon.h"
#include "imager/noise.h"
#include "imager/sampling.h"
#include "imager/stage_times.h"

namespace misfit::tools {
namespace {

constexpr int model_pixels = 60;
constexpr std::size_t samples_a_block = 400;  ///< at which predictions are compared

/// The sum of squares and the largest magnitude of some differences.
struct Tally {
  double square = 0;
  double largest = 0;
  std::size_t count = 0;

  void add(double difference) {
    square += difference * difference;
    largest = std::max(largest, std::abs(difference));
    ++count;
  }
  double rms() const { return std::sqrt(square / static_cast<double>(std::max<std::size_t>(count, 1))); }
};

}  // namespace

SceneTruth::SceneTruth(const imager::VisibilitySource& source, const imager::ImageGeometry& geometry, int pixels, int threads,
                       const imager::Progress& progress)
    : geometry_(geometry), model_(geometry.width, geometry.height) {
  choose_pixels(pixels);
  std::mt19937_64 random(20200113);
  for (std::size_t k = 0; k < pixel_.size() && k < model_pixels; ++k)
    model_.at(pixel_[k].row, pixel_[k].column) = random() % 2 == 0 ? 1 : -1;

  const imager::DirectPixels at{geometry, pixel_, true, threads};
  const auto predict = imager::DirectTransform(geometry, threads).predict(model_);
  direct_.resize(pixel_.size());
  double weight = 0, seconds = 0;
  imager::SampleCounts counts;
  std::uint64_t done = 0;
  std::size_t index = 0;
  const auto stream = source.open();
  for (auto block = stream->next(); block; block = stream->next(), ++index) {
    const imager::Stopwatch watch;
    imager::add_direct_pixels(*block, at, direct_);
    seconds += watch.seconds();
    imager::SampleSums sums;
    for (const float w : imager::imaging_weights(*block, geometry.cell_rad, threads, sums)) weight += double{w};
    imager::SampleCoordinates one{{}, {0}};
    for (std::size_t i = 0; i < samples_a_block; ++i) {
      const std::size_t sample = random() % block->samples();
      if (block->weight[sample] == 0) continue;
      const double* uvw_m = &block->uvw_m[3 * (sample / block->channels())];
      one.uvw_m.assign(uvw_m, uvw_m + 3);
      one.frequency_hz.front() = block->frequency_hz[sample % block->channels()];
      samples_.push_back({index, sample, predict->at(one).front()});
      visibility_square_ += std::norm(samples_.back().visibility);
    }
    counts += block->counts;
    done += block->samples();
    progress(done, source.samples());
  }
  if (counts.used == 0) throw imager::NothingUsable(counts);
  for (double& pixel : direct_) pixel /= weight;
  seconds_a_pixel_ = seconds / static_cast<double>(std::max<std::size_t>(pixel_.size(), 1));
}

void SceneTruth::choose_pixels(int count) {
  std::mt19937_64 random(20200112);
  const int width = geometry_.width, height = geometry_.height;
  const auto offer = [&](int row, int column, Place place) {
    if (imager::beyond_horizon(geometry_.at(row, column))) return;
    pixel_.push_back({row, column});
    place_.push_back(place);
  };
  for (const int row : {0, height - 1})
    for (const int column : {0, width - 1}) offer(row, column, Place::border);
  const auto within = [&](int size, double from, double to) {
    const auto first = static_cast<int>(from * size), last = std::max(first, static_cast<int>(std::ceil(to * size)) - 1);
    return first + static_cast<int>(random() % static_cast<std::uint64_t>(last - first + 1));
  };
  constexpr double edge = 1.0 / 16;
  for (int i = 0; i < count; ++i) {
    offer(within(height, 0, 1), within(width, 0, 1), Place::anywhere);
    offer(within(height, 0.25, 0.75), within(width, 0.25, 0.75), Place::centre);
    const bool low = random() % 2 == 0, upright = random() % 2 == 0;
    const auto near = [&](int size) { return low ? within(size, 0, edge) : within(size, 1 - edge, 1); };
    const int row = upright ? within(height, 0, 1) : near(height), column = upright ? near(width) : within(width, 0, 1);
    offer(row, column, Place::border);
  }
}

SceneErrors SceneTruth::errors_of(const imager::Image& dirty) const {
  Tally anywhere, centre, border, all;
  for (std::size_t k = 0; k < pixel_.size(); ++k) {
    const double difference = dirty.at(pixel_[k].row, pixel_[k].column) - direct_[k];
    all.add(difference);
    (place_[k] == Place::anywhere ? anywhere : place_[k] == Place::centre ? centre : border).add(difference);
  }
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  SceneErrors errors{anywhere.rms(), all.largest, centre.rms(), centre.largest, border.rms(), border.largest, none, none};
  const double image_rms = imager::root_mean_square(dirty);
  for (double* error :
       {&errors.rms, &errors.max, &errors.centre_rms, &errors.centre_max, &errors.border_rms, &errors.border_max})
    *error /= image_rms;
  return errors;
}

void SceneTruth::compare(std::size_t block, const std::vector<std::complex<double>>& predicted, SceneErrors& errors) const {
  if (block == 0) errors.predict_rms = errors.predict_max = 0;
  for (const ChosenSample& chosen : samples_) {
    if (chosen.block != block) continue;
    const double square = std::norm(predicted[chosen.sample] - chosen.visibility);
    errors.predict_rms += square;
    errors.predict_max = std::max(errors.predict_max, square);
  }
}

void SceneTruth::finish(SceneErrors& errors) const {
  errors.predict_rms = std::sqrt(errors.predict_rms / visibility_square_);
  errors.predict_max = std::sqrt(errors.predict_max / (visibility_square_ / static_cast<double>(samples_.size())));
}

}  // namespace misfit::tools
