// Times on one core of the pieces of gridding, in nanoseconds a visibility (of the FFT: a point), as a markdown table.
// usage: misfit_micro [--runs N] [--only TEXT] [--json FILE]      pieces whose name contains TEXT
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>
#include <string>

#include "imager/coplanar/batch_taps.h"
#include "imager/coplanar/coplanar_transform.h"
#include "imager/coplanar/tile_loops.h"
#include "imager/coplanar/tile_order.h"
#include "imager/direct/source_sums.h"
#include "imager/numerics/fft.h"
#include "imager/wide/wide_transform.h"
#include "kernels/catalogue.h"
#include "kernels/cheapest_polynomial.h"

namespace {

using namespace misfit;
using namespace misfit::imager;

constexpr int tile = 32;
constexpr double x0 = 0.25;
constexpr double cell_rad = 1e-5;

/// A piece to time: one call of `run` takes `visibilities` through it.
struct Piece {
  std::string name;
  double visibilities = 1;
  std::function<void()> run;
};

/// The distances between consecutive samples of a tile: rows enter the tile anywhere, and their channels step through it.
struct Walk {
  const char* name;
  double cells_a_channel;
};
constexpr std::array<Walk, 3> walks{{{"1/8 cell a channel", 0.125}, {"1 cell a channel", 1}, {"scattered", 100}}};

template <typename Real>
std::vector<TileBatch<Real>> batches_of(const Walk& walk) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<TileBatch<Real>> batches(16 * 128 / TileBatch<Real>::capacity);
  double u = -1, v = -1, angle = 0;
  for (TileBatch<Real>& batch : batches)
    while (batch.count < TileBatch<Real>::capacity) {
      u += walk.cells_a_channel * std::cos(angle);
      v += walk.cells_a_channel * std::sin(angle);
      if (u < 0 || v < 0 || u >= tile || v >= tile) {
        u = tile * uniform(random);
        v = tile * uniform(random);
        angle = 2 * pi * uniform(random);
      }
      const int i = batch.count++;
      batch.column[i] = static_cast<int>(u);
      batch.row[i] = static_cast<int>(v);
      batch.tu[i] = static_cast<Real>(u - std::floor(u) - 0.5);
      batch.tv[i] = static_cast<Real>(v - std::floor(v) - 0.5);
      for (auto& value : batch.value) value[i] = static_cast<Real>(uniform(random) - 0.5);
    }
  return batches;
}

/// The loops over tiles for one width and precision.
template <typename Real>
void add_loops(int width, std::vector<Piece>& pieces) {
  const std::string of = "W = " + std::to_string(width) + (sizeof(Real) == 4 ? " single, " : " double, ");
  const TapTable<Real> taps(kernels::cheapest_polynomial(kernels::kernel_family("least-misfit").make(width, x0), 0.005));
  const auto alone = std::make_shared<std::vector<TileBatch<Real>>>(batches_of<Real>(walks[0]));
  const double visibilities = static_cast<double>(alone->size()) * TileBatch<Real>::capacity;
  pieces.push_back({of + "taps of degree " + std::to_string(taps.degree), visibilities, [taps, alone] {
                      BatchTaps<Real, TileBatch<Real>::capacity> out;
                      for (const TileBatch<Real>& batch : *alone)
                        for (const Real* t : {batch.tu, batch.tv}) evaluate_taps(taps, t, batch.count, out.value);
                    }});
  for (const Walk& walk : walks) {
    const auto batches = std::make_shared<std::vector<TileBatch<Real>>>(batches_of<Real>(walk));
    for (const int planes : {2, 3}) {
      const auto buffer = std::make_shared<TileBuffer<Real>>(tile, taps.padded, planes);
      pieces.push_back({of + "spread " + std::to_string(planes) + ", " + walk.name, visibilities, [=] {
                          for (const TileBatch<Real>& batch : *batches) spread(taps, taps, batch, buffer->cells());
                        }});
    }
    const auto buffer = std::make_shared<TileBuffer<Real>>(tile, taps.padded, 2);
    const auto into = std::make_shared<std::vector<TileBatch<Real>>>(*batches);  // spreading must not see what this writes
    pieces.push_back({of + "interpolate, " + walk.name, visibilities, [=] {
                        for (TileBatch<Real>& batch : *into) interpolate(taps, taps, buffer->cells(), batch);
                      }});
  }
}

/// Rows all over the grid with 64 channels over 5 % of the frequency.
VisibilityBlock block_of(std::size_t rows) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  VisibilityBlock block;
  for (int channel = 0; channel < 64; ++channel) block.frequency_hz.push_back(1e9 * (1 + 0.05 * channel / 64));
  const double edge_m = 0.45 / cell_rad * speed_of_light_m_s / block.frequency_hz.back();
  for (std::size_t row = 0; row < rows; ++row)
    for (const double x : {uniform(random), uniform(random), 0.0}) block.uvw_m.edit().push_back(edge_m * x * std::abs(x));
  for (std::size_t i = 0; i < block.samples(); ++i) {
    block.visibility.emplace_back(static_cast<float>(uniform(random)), static_cast<float>(uniform(random)));
    block.weight.push_back(1);
  }
  return block;
}

void add_ordering(std::vector<Piece>& pieces) {
  const auto block = std::make_shared<VisibilityBlock>(block_of(4096));
  imager::ImageGeometry image;
  image.cell_rad = cell_rad;
  for (const Wanted wanted : {Wanted::imaging, Wanted::usable})
    pieces.push_back({std::string("order_by_tile for ") + (wanted == Wanted::imaging ? "imaging" : "prediction"),
                      static_cast<double>(block->samples()), [block, image, wanted] {
                        order_by_tile(*block, {*block, 1}, {2048, 2048, 7, tile}, image, wanted, 1);
                      }});
}

/// A transform's whole work on a block in memory, without its FFT.
void add_transform(Precision precision, std::vector<Piece>& pieces) {
  CoplanarOptions options;
  options.geometry = {1024, 1024, cell_rad, {}};
  options.nu = options.nv = 2048;
  options.kernel_u = kernels::kernel_family("least-misfit").make(7, x0);
  options.kernel_u.polynomial = kernels::cheapest_polynomial(options.kernel_u, 0.005);
  options.kernel_v = options.kernel_u;
  options.precision = precision;
  const std::shared_ptr<Transform> transform = make_coplanar_transform(options);
  const auto block = std::make_shared<VisibilityBlock>(block_of(16384));
  const auto samples = static_cast<double>(block->samples());
  const std::string of = std::string("W = 7 ") + (precision == Precision::single_precision ? "single" : "double") + ", block ";
  for (const bool with_psf : {false, true}) {
    const std::shared_ptr<AdjointSum> sum = transform->adjoint({.with_psf = with_psf});
    pieces.push_back({of + (with_psf ? "to grids of image and PSF" : "to the grid"), samples,
                      [transform, block, sum] { sum->add(*block); }});
  }
  Image model(1024, 1024);
  model.at(300, 400) = 1;
  const std::shared_ptr<Prediction> prediction = transform->predict(model);
  pieces.push_back({of + "from the grid", samples, [transform, block, prediction] { prediction->at_usable(*block); }});
}

/// Ten million samples of four Stokes parameters, with w up to 45 % of 1/cell; made when they are first asked for.
const VisibilityBlock& large_block() {
  static const VisibilityBlock block = [] {
    VisibilityBlock first = block_of(156250);
    for (std::size_t row = 0; row < first.rows(); ++row)
      first.uvw_m.edit()[3 * row + 2] = first.uvw_m[3 * ((row + 7) % first.rows())];
    const std::vector<std::complex<float>> one = first.visibility;
    for (int s = 1; s < most_stokes; ++s) first.visibility.insert(first.visibility.end(), one.begin(), one.end());
    return first;
  }();
  return block;
}

/// Dirty images of 1024 × 1024 pixels in single precision, FFTs counted in.
void add_stokes(bool wide, std::vector<Piece>& pieces) {
  WideTransformOptions options;
  options.geometry = {1024, 1024, cell_rad, {}};
  options.nu = options.nv = 2048;
  options.kernel_u = kernels::kernel_family("least-misfit").make(7, x0);
  options.kernel_u.polynomial = kernels::cheapest_polynomial(options.kernel_u, 0.005);
  options.kernel_v = options.kernel_u;
  if (wide) options.kernel_w = options.kernel_u;
  options.precision = Precision::single_precision;
  const std::shared_ptr<Transform> transform = make_transform(options);
  for (const AdjointOptions made : {AdjointOptions{1, false}, {1, true}, {4, true}})
    pieces.push_back({std::string(wide ? "wide" : "plane") + " W = 7 single, 10^7 samples to " + std::to_string(made.images) +
                          " Stokes" + (made.with_psf ? " and PSF" : ""),
                      1e7, [transform, made] {
                        const auto sum = transform->adjoint(made);
                        sum->add(large_block());
                        sum->finish();
                      }});
}

template <typename Real>
void add_fft(int length, std::vector<Piece>& pieces) {
  const auto fft = std::make_shared<Fft<Real>>(length);
  const std::shared_ptr<std::complex<Real>[]> row(fft->complex_buffer());
  std::fill_n(row.get(), length, std::complex<Real>(0));
  pieces.push_back({"FFT of a row of " + std::to_string(length) + (sizeof(Real) == 4 ? ", single" : ", double"),
                    static_cast<double>(length), [=] { fft->complex_to_complex(row.get(), Fft<Real>::Sign::forward); }});
}

/// Direct sums over sources, all points or all Gaussians that baselines hardly resolve.
void add_source_sums(std::vector<Piece>& pieces) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double fwhm_rad : {0.0, cell_rad})
    for (const std::size_t channels : {1, 4, 64}) {
      SampleCoordinates at = block_of(1024);
      at.frequency_hz.resize(channels);
      std::vector<Source> sources;
      for (int i = 0; i < 256; ++i)
        sources.push_back({{500 * cell_rad * uniform(random), 500 * cell_rad * uniform(random)}, uniform(random), fwhm_rad});
      pieces.push_back({std::string("direct sum over ") + (fwhm_rad > 0 ? "Gaussians" : "points") + ", " +
                            std::to_string(channels) + " channels, a source",
                        static_cast<double>(at.samples() * sources.size()), [=] { predict_sources(sources, at, 1); }});
    }
}

/// The time of some calls in a row, after one that warms the piece's caches and branch prediction.
double time_ns(const Piece& piece) {
  const int calls = piece.visibilities > 5e6 ? 1 : 5;
  piece.run();
  const auto start = std::chrono::steady_clock::now();
  for (int call = 0; call < calls; ++call) piece.run();
  const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
  return taken.count() / (calls * piece.visibilities);
}

double quantile(const std::vector<double>& sorted, double q) {
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

int main(int argc, char** argv) {
  int runs = 51;
  std::string json_file, only;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string(argv[i]) == "--runs") runs = std::max(1, std::atoi(argv[i + 1]));
    if (std::string(argv[i]) == "--json") json_file = argv[i + 1];
    if (std::string(argv[i]) == "--only") only = argv[i + 1];
  }
  std::vector<Piece> pieces;
  for (int width = 4; width <= 12; ++width) {
    add_loops<float>(width, pieces);
    add_loops<double>(width, pieces);
  }
  add_ordering(pieces);
  add_transform(Precision::single_precision, pieces);
  add_transform(Precision::double_precision, pieces);
  add_stokes(false, pieces);
  add_stokes(true, pieces);
  add_fft<float>(4096, pieces);
  add_fft<double>(4096, pieces);
  add_source_sums(pieces);
  std::erase_if(pieces, [&](const Piece& piece) { return piece.name.find(only) == std::string::npos; });

  std::vector<std::vector<double>> times(pieces.size());
  for (int run = 0; run < runs; ++run)  // in turn, so that all share what else the machine does
    for (std::size_t i = 0; i < pieces.size(); ++i) times[i].push_back(time_ns(pieces[i]));

  nlohmann::json report = nlohmann::json::array();
  std::printf("| piece | median, ns | quartiles | least |\n|---|---|---|---|\n");
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    std::sort(times[i].begin(), times[i].end());
    const double median = quantile(times[i], 0.5), low = quantile(times[i], 0.25), high = quantile(times[i], 0.75);
    std::printf("| %s | %.2f | %.2f–%.2f | %.2f |\n", pieces[i].name.c_str(), median, low, high, times[i].front());
    report.push_back(
        {{"piece", pieces[i].name}, {"median_ns", median}, {"quartiles_ns", {low, high}}, {"least_ns", times[i].front()}});
  }
  if (!json_file.empty()) std::ofstream(json_file) << report.dump(2) << '\n';
}
