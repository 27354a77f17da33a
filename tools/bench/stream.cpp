// Shows whether data of any size are imaged in bounded memory, at the speed of small ones: visibilities of a made-up array are
// generated as they are read, and never stored, so that 10^9 of them need no disk.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "imager/numerics/parallel.h"
#include "imager/plan/accurate_imaging.h"
#include "kernels/kernel_cache.h"
#include "ms_io/measurement_set.h"
#include "tools/base/memory.h"
#include "tools/run/memory_plan.h"

namespace {

using namespace misfit;

constexpr std::size_t antennas = 60, baselines = antennas * (antennas - 1) / 2, channels = 64;
constexpr double reach_m = 20e3, first_hz = 1.3e9, channel_hz = 1e6, declination = 0.6, hours = 8;

/// A random number for each number, between 0 and 1.
double random_of(std::uint64_t number) {
  number = (number + 0x9E3779B97F4A7C15U) * 0xBF58476D1CE4E5B9U;
  number = (number ^ (number >> 27U)) * 0x94D049BB133111EBU;
  return static_cast<double>((number ^ (number >> 31U)) >> 11U) * 0x1p-53;
}

/// So many samples of antennas strewn over a disc, with noise for visibilities.
class GeneratedSource : public imager::VisibilitySource {
 public:
  GeneratedSource(std::uint64_t samples, bool coplanar) : rows_(samples / channels), coplanar_(coplanar) {
    for (std::size_t a = 0; a < antennas; ++a) {
      const double radius = reach_m / 2 * std::pow(random_of(2 * a), 1.5), angle = 2 * M_PI * random_of(2 * a + 1);
      east_m_.push_back(radius * std::cos(angle));
      north_m_.push_back(radius * std::sin(angle));
    }
  }

  std::unique_ptr<imager::BlockStream> open() const override { return std::make_unique<Stream>(*this); }
  std::uint64_t samples() const override { return rows_ * channels; }
  std::uint64_t rows() const { return rows_; }
  double max_abs_w() const { return coplanar_ ? 0 : reach_m * (first_hz + channel_hz * channels) / 2.99792458e8; }

 private:
  class Stream : public imager::BlockStream {
   public:
    explicit Stream(const GeneratedSource& source) : source_(source) {}

    std::shared_ptr<const imager::VisibilityBlock> next() override {
      if (row_ == source_.rows_) return nullptr;
      const std::uint64_t rows =
          std::min<std::uint64_t>(ms_io::MeasurementSet::usual_block_samples / channels, source_.rows_ - row_);
      auto block = std::make_shared<imager::VisibilityBlock>();
      for (std::size_t c = 0; c < channels; ++c) block->frequency_hz.push_back(first_hz + channel_hz * static_cast<double>(c));
      auto& uvw_m = block->uvw_m.edit();
      uvw_m.resize(3 * rows);
      for (std::uint64_t r = 0; r < rows; ++r) source_.place(row_ + r, &uvw_m[3 * r]);
      block->visibility.resize(rows * channels);
      block->weight.assign(rows * channels, 1);
      for (std::complex<float>& v : block->visibility) {
        seed_ = seed_ * 6364136223846793005U + 1442695040888963407U;
        v = {static_cast<float>(static_cast<std::int32_t>(seed_ >> 32U)) * 0x1p-31F,
             static_cast<float>(static_cast<std::int32_t>(seed_)) * 0x1p-31F};
      }
      block->counts.rows_read = rows;
      block->counts.samples_read = block->counts.used = rows * channels;
      row_ += rows;
      return block;
    }

   private:
    const GeneratedSource& source_;
    std::uint64_t row_ = 0;
    std::uint64_t seed_ = 1;
  };

  /// The UVW of a row: rows are all baselines of one time, then of the next; times are spread over the hours.
  void place(std::uint64_t row, double* uvw_m) const {
    std::uint64_t baseline = row % baselines;
    std::size_t a = 0;
    for (; baseline >= antennas - 1 - a; ++a) baseline -= antennas - 1 - a;
    const std::size_t b = a + 1 + baseline;
    const double turns = static_cast<double>(row / baselines) / static_cast<double>(rows_ / baselines + 1);
    const double angle = hours / 24 * 2 * M_PI * (turns - 0.5), east = east_m_[b] - east_m_[a],
                 north = north_m_[b] - north_m_[a];
    const double x = -std::sin(declination) * north, z = std::cos(declination) * north;
    uvw_m[0] = std::sin(angle) * x + std::cos(angle) * east;
    uvw_m[1] = -std::sin(declination) * (std::cos(angle) * x - std::sin(angle) * east) + std::cos(declination) * z;
    uvw_m[2] =
        coplanar_ ? 0 : std::cos(declination) * (std::cos(angle) * x - std::sin(angle) * east) + std::sin(declination) * z;
  }

  std::uint64_t rows_;
  bool coplanar_;
  std::vector<double> east_m_, north_m_;
};

struct Options {
  std::vector<double> samples{1e7, 1e9};
  int pixels = 2048;
  double cell_arcsec = 1;
  double accuracy = 1e-4;
  double memory_gib = 2;
  int threads = 0;
  bool coplanar = false;
};

struct Planned {
  imager::GriddingPlan gridding;
  tools::MemoryPlan memory;
};

/// The plan as `misfit image` makes it.
Planned plan_for(const GeneratedSource& source, const Options& o) {
  imager::GriddingRequest request;
  request.geometry = {o.pixels, o.pixels, o.cell_arcsec * M_PI / 180 / 3600, {}};
  request.kernel = kernels::cached(request.kernel, "");
  request.accuracy = request.psf_accuracy = o.gridding.accuracy;
  request.samples = source.samples();
  request.max_abs_w = source.max_abs_w();
  request.threads = o.threads;
  tools::limit_memory(o.memory_gib * tools::gib, request);
  tools::ImageOptions options;
  options.memory_gib = o.memory_gib;
  options.imsize = {o.pixels, o.pixels};
  const auto demand = [&](const imager::GriddingPlan& plan) {
    return imager::MemoryDemand{.transform = imager::memory_of(plan),
                                .pixels = static_cast<double>(plan.request.geometry.pixels()),
                                .rows = static_cast<double>(source.rows()),
                                .samples = static_cast<double>(source.samples()),
                                .block_samples = static_cast<double>(ms_io::MeasurementSet::usual_block_samples)};
  };
  const double machine_bytes = tools::physical_memory_bytes();
  imager::GriddingPlan plan = tools::plan_with_room(request, demand, options, machine_bytes);
  const tools::MemoryPlan memory = tools::plan_memory(demand(plan), options, machine_bytes);
  return {std::move(plan), memory};
}

/// Runs once, and returns nanoseconds a sample.
double run(double samples, const Options& o) {
  const GeneratedSource source(static_cast<std::uint64_t>(samples), o.coplanar);
  const auto [plan, memory] = plan_for(source, o);
  const imager::StreamedVisibilities streamed(source, memory.streaming);
  imager::StageTimes times;
  const imager::Stopwatch watch;
  const imager::AccurateImages made = imager::make_accurate_images(streamed, plan, {.times = &times});
  const double seconds = watch.seconds(), a_sample_ns = 1e9 * seconds / static_cast<double>(source.samples());
  std::printf("| %.3g | %.2f | %.2f | %.2f | %d | %.2f | %.2f | %.2f | %s |\n", static_cast<double>(source.samples()), seconds,
              times.of(imager::stage::grid), times.of(imager::stage::fft), plan.choice.best.work.gathers, a_sample_ns,
              memory.peak.total() / tools::gib, tools::peak_memory_bytes() / tools::gib,
              memory.streaming.keep ? "kept" : "streamed");
  std::fflush(stdout);
  if (made.images.sums.front().used != source.samples()) throw std::runtime_error("samples were lost");
  return a_sample_ns;
}

}  // namespace

int main(int count, char** argument) {
  CLI::App command("Images generated visibilities of several numbers of samples in bounded memory");
  Options o;
  command.add_option("samples", o.samples, "Numbers of samples, in ascending order")->capture_default_str();
  command.add_option("--imsize", o.pixels, "Pixels along a side")->capture_default_str();
  command.add_option("--cell", o.cell_arcsec, "Arcseconds of a pixel")->capture_default_str();
  command.add_option("--accuracy", o.gridding.accuracy, "As misfit image has it")->capture_default_str();
  command.add_option("--memory", o.memory_gib, "GiB, as misfit image has it")->capture_default_str();
  command.add_option("--threads", o.threads, "0 = all cores")->capture_default_str();
  command.add_flag("--coplanar", o.coplanar, "Without w");
  CLI11_PARSE(command, count, argument);
  if (o.threads == 0) o.threads = imager::available_threads();
  try {
    std::printf(
        "| samples | s | gridding s | reading s | ns a sample | planned GiB | peak GiB | visibilities |\n"
        "|---:|---:|---:|---:|---:|---:|---:|---|\n");
    double first = 0;
    for (const double samples : o.samples) {
      const double a_sample_ns = run(samples, o);
      if (first == 0) first = a_sample_ns;
      std::printf("%s", samples == o.samples.back() && o.samples.size() > 1 ? "\n" : "");
      if (samples == o.samples.back() && o.samples.size() > 1)
        std::printf("The last takes %.3f of the first's time a sample.\n", a_sample_ns / first);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "misfit_stream: %s\n", error.what());
    return 1;
  }
  return 0;
}
