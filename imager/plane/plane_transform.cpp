#include "imager/plane/plane_transform.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "imager/horizon.h"
#include "imager/parallel.h"
#include "imager/plane/correction.h"
#include "imager/plane/crowded_tiles.h"
#include "imager/plane/half_grid.h"
#include "imager/plane/tile_walk.h"
#include "imager/stage_times.h"
#include "imager/sum_unit.h"

namespace misfit::imager {
namespace {

constexpr int tile_side = 32;  // with 16, half of the cells that a tile of W = 7 flushes lie beyond it

/// Everything that both directions share.
template <typename Real>
struct Setup {
  ImageGeometry geometry;
  GridShape shape;
  TapTable<Real> taps_u;
  TapTable<Real> taps_v;
  ImageCorrection correction;
  int threads;
};

/// The four colours of tiles that hold samples; those of one colour may be flushed at the same time, since their buffers reach
/// into the next tile alone. The fullest first within a colour so that no thread starts the longest task last.
std::vector<std::vector<TileTask>> coloured_tasks(const TileOrder& order, const GridShape& shape) {
  std::vector<std::vector<TileTask>> colours(4);
  for (int v = 0; v < shape.tiles_v(); ++v)
    for (int u = 0; u < shape.tiles_u(); ++u) {
      const auto tile = static_cast<std::size_t>(v) * static_cast<std::size_t>(shape.tiles_u()) + static_cast<std::size_t>(u);
      if (order.samples[tile] != 0) colours[static_cast<std::size_t>(v % 2 * 2 + u % 2)].push_back({u, v, tile});
    }
  for (std::vector<TileTask>& tasks : colours)
    std::stable_sort(tasks.begin(), tasks.end(),
                     [&](const TileTask& a, const TileTask& b) { return order.samples[a.tile] > order.samples[b.tile]; });
  return colours;
}

/// Where the grid's rows of a tile begin.
std::size_t first_cell(const GridShape& shape, const TileTask& task, int row) {
  return static_cast<std::size_t>(task.tile_v * shape.tile + row) * static_cast<std::size_t>(shape.columns()) +
         static_cast<std::size_t>(task.tile_u * shape.tile);
}

/// Asks for a tile's part of a plane of the grid, so that it is at hand once its samples have been dealt with.
template <typename Real>
void prefetch_tile(const GridShape& shape, const TileTask& task, const Real* plane) {
  constexpr int line = 64 / sizeof(Real);
  const int reach = shape.tile + shape.width - 1;
  for (int r = 0; r < reach; ++r)
    for (int c = 0; c < reach + line - 1; c += line) hwy::Prefetch(plane + first_cell(shape, task, r) + std::min(c, reach - 1));
}

/// Where a tile lies in the planes of the grid.
template <typename Real>
TileCells<Real> cells_of(const GridShape& shape, const TileTask& task, const std::vector<Real*>& planes) {
  TileCells<Real> cells{static_cast<int>(planes.size()), {}, shape.columns()};
  for (std::size_t i = 0; i < planes.size(); ++i) cells.plane[i] = planes[i] + first_cell(shape, task, 0);
  return cells;
}

/// A tile of no more samples is gridded and degridded where it lies in the grid: a buffer costs more to bring and to add.
/// Measured for W = 4, 7 and 12: below 120 samples that holds in both directions, above 240 in none.
constexpr std::size_t most_in_place = 192;
bool sparse(const TileOrder& order, const TileTask& task) {
  return order.samples[task.tile] <= most_in_place;
}

/// Sums in single precision stay short: a buffer is added to the grid after so many samples, sooner where the tile is crowded.
constexpr int most_in_buffer = 2048;
constexpr int most_in_crowded_buffer = 1024;

template <typename Real>
class PlaneAdjoint : public AdjointSum {
 public:
  PlaneAdjoint(const Setup<Real>& setup, const AdjointOptions& options)
      : AdjointSum(options), setup_(setup), value_unit_(images()), sums_(images()) {
    grid_.resize(2 * images() + (options.with_psf ? 1 : 0));
    for (auto& plane : grid_) {
      plane.resize(setup.shape.cells());
      planes_.push_back(plane.data());
    }
  }

  AdjointResult finish() override {
    const Stopwatch watch;
    flush_crowded();
    AdjointResult result;
    result.sums = sums_;
    for (std::size_t i = 0; i < images(); ++i)
      result.images.push_back(to_image(std::move(grid_[2 * i]), std::move(grid_[2 * i + 1]), value_unit_[i].unit()));
    if (options_.with_psf) result.psf = to_image(std::move(grid_.back()), {}, weight_unit_.unit());
    result.fft_s = watch.seconds();
    return result;
  }

 protected:
  void add_sets(const VisibilityBlock& block, const std::vector<VisibilitySet>& sets) override {
    const TileOrder order = order_by_tile(block, sets, setup_.shape, setup_.geometry.cell_rad, Wanted::imaging, setup_.threads);
    for (std::size_t i = 0; i < images(); ++i) sums_[i] += order.sums[i];
    make_room(order.sums);
    crowded_.count(order.samples, most_in_place, TileBuffer<double>(setup_.shape.tile, setup_.taps_u.padded, plane_count()));
    for (const std::vector<TileTask>& tasks : coloured_tasks(order, setup_.shape))
      parallel_for(tasks.size(), setup_.threads, [&](std::size_t i) { grid_tile(block, sets, order, tasks[i]); });
  }

 private:
  std::size_t images() const { return static_cast<std::size_t>(options_.images); }
  int plane_count() const { return static_cast<int>(planes_.size()); }

  Image to_image(std::vector<Real> real, std::vector<Real> imaginary, double unit) const {
    Image image = grid_to_image(setup_.shape, std::move(real), std::move(imaginary), setup_.correction, setup_.threads);
    if (unit != 1)
      for (double& pixel : image.pixel) pixel *= unit;
    set_beyond_horizon(setup_.geometry, no_value, image);
    return image;
  }

  /// Brings the grid to the units that hold the samples to come too.
  void make_room(const std::vector<SampleSums>& coming) {
    std::vector<double> by;  // [plane]
    for (std::size_t i = 0; i < images(); ++i) by.insert(by.end(), 2, value_unit_[i].make_room(coming[i].weight_abs));
    if (options_.with_psf) by.push_back(weight_unit_.make_room(coming.front().weight));
    if (std::all_of(by.begin(), by.end(), [](double factor) { return factor == 1; })) return;
    for (std::size_t plane = 0; plane < by.size(); ++plane)
      for (Real& cell : grid_[plane]) cell = static_cast<Real>(cell * by[plane]);
    for (std::size_t tile = 0; tile < crowded_.tiles(); ++tile) {
      TileBuffer<double>* const sum = crowded_.of(tile);
      if (sum == nullptr) continue;
      for (int r = 0; r < sum->rows; ++r)
        for (int plane = 0; plane < sum->planes; ++plane)
          for (int c = 0; c < sum->columns; ++c) sum->row(r, plane)[c] *= by[static_cast<std::size_t>(plane)];
    }
  }

  void grid_tile(const VisibilityBlock& block, const std::vector<VisibilitySet>& sets, const TileOrder& order,
                 const TileTask& task) {
    TileBuffer<double>* const crowded = crowded_.of(task.tile);
    const bool in_place = crowded == nullptr && sparse(order, task);
    TileBuffer<Real> buffer(setup_.shape.tile, setup_.taps_u.padded, in_place ? 0 : plane_count());
    const TileCells<Real> cells = in_place ? cells_of(setup_.shape, task, planes_) : buffer.cells();
    if (!in_place)
      for (const Real* plane : planes_) prefetch_tile(setup_.shape, task, plane);
    const auto ahead = [&](std::size_t sample) {
      hwy::Prefetch(&block.weight[sample]);
      for (const VisibilitySet& set : sets)
        std::visit([&](const auto* visibility) { hwy::Prefetch(visibility + sample); }, set);
    };
    const auto empty_buffer = [&] { crowded == nullptr ? flush(task, buffer) : add_up(buffer, *crowded); };
    int in_buffer = 0;
    const auto done = [&](TileBatch<Real>& batch, const BatchSamples& samples) {
      set_values(block, sets, samples, batch);
      spread(setup_.taps_u, setup_.taps_v, batch, cells);
      in_buffer += batch.count;
      if (in_place || in_buffer < (crowded == nullptr ? most_in_buffer : most_in_crowded_buffer)) return;
      empty_buffer();
      std::fill(buffer.cell.begin(), buffer.cell.end(), Real(0));
      in_buffer = 0;
    };
    for_each_batch<Real>(setup_.geometry, setup_.shape, block, order, task, ahead, done);
    if (!in_place) empty_buffer();
  }

  /// The grid holds conj(V), whose backward transform is the image; see tile_order.h for the axes.
  void set_values(const VisibilityBlock& block, const std::vector<VisibilitySet>& sets, const BatchSamples& samples,
                  TileBatch<Real>& batch) const {
    double weight[BatchSamples::capacity];
    for (int k = 0; k < batch.count; ++k) weight[k] = block.weight[samples.index[k]];
    for (std::size_t i = 0; i < sets.size(); ++i) {
      const double per_unit = value_unit_[i].per_unit();
      Real *const real = batch.value[2 * i], *const imaginary = batch.value[2 * i + 1];
      const auto set_both = [&](const auto* visibility) {
        for (int k = 0; k < batch.count; ++k) {
          const double scaled = weight[k] * per_unit;
          const std::complex<double> value = samples.from_middle(std::complex<double>(visibility[samples.index[k]]), k);
          real[k] = static_cast<Real>(scaled * value.real());
          imaginary[k] = static_cast<Real>(samples.conjugate[k] ? scaled * value.imag() : -scaled * value.imag());
        }
      };
      std::visit(set_both, sets[i]);
    }
    if (!options_.with_psf) return;
    const double per_unit = weight_unit_.per_unit();
    for (int k = 0; k < batch.count; ++k) batch.value[2 * sets.size()][k] = static_cast<Real>(weight[k] * per_unit);
  }

  static void add_up(const TileBuffer<Real>& buffer, TileBuffer<double>& to) {
    for (std::size_t i = 0; i < buffer.cell.size(); ++i) to.cell[i] += double{buffer.cell[i]};
  }

  void flush_crowded() {
    const auto tiles_u = static_cast<std::size_t>(setup_.shape.tiles_u());
    for (std::size_t tile = 0; tile < crowded_.tiles(); ++tile)
      if (TileBuffer<double>* const sum = crowded_.of(tile); sum != nullptr)
        flush({static_cast<int>(tile % tiles_u), static_cast<int>(tile / tiles_u), tile}, *sum);
  }

  template <typename Sum>
  void flush(const TileTask& task, TileBuffer<Sum>& buffer) {
    const int reach = setup_.shape.tile + setup_.shape.width - 1;
    for (int r = 0; r < reach; ++r) {
      const std::size_t start = first_cell(setup_.shape, task, r);
      for (int plane = 0; plane < buffer.planes; ++plane) {
        const Sum* from = buffer.row(r, plane);
        Real* to = planes_[static_cast<std::size_t>(plane)] + start;
        for (int c = 0; c < reach; ++c) to[c] = static_cast<Real>(to[c] + from[c]);
      }
    }
  }

  const Setup<Real>& setup_;
  std::vector<std::vector<Real>> grid_;  ///< [plane]: real and imaginary parts of each image; last, with a PSF, weights
  std::vector<Real*> planes_;
  CrowdedTiles<Real> crowded_;
  std::vector<SumUnit<Real>> value_unit_;  ///< [image], of real and imaginary parts
  SumUnit<Real> weight_unit_;              ///< of the weights
  std::vector<SampleSums> sums_;           ///< [image]
};

template <typename Real>
class PlanePrediction : public Prediction {
 public:
  PlanePrediction(const Setup<Real>& setup, const Image& model) : setup_(setup), grid_(setup.shape) {
    const Stopwatch watch;
    if (!crosses_horizon(setup.geometry)) {
      image_to_grid(model, setup.correction, setup.threads, grid_);
    } else {
      Image seen = model;
      set_beyond_horizon(setup.geometry, 0, seen);
      image_to_grid(seen, setup.correction, setup.threads, grid_);
    }
    fft_s_ = watch.seconds();
  }

  std::vector<std::complex<double>> at(const SampleCoordinates& coordinates) const override {
    VisibilityBlock block;
    static_cast<SampleCoordinates&>(block) = coordinates;
    return degrid(block, Wanted::all);
  }
  std::vector<std::complex<double>> at_usable(const VisibilityBlock& block) const override {
    return degrid(block, Wanted::usable);
  }
  double fft_s() const override { return fft_s_; }

 private:
  std::vector<std::complex<double>> degrid(const VisibilityBlock& block, Wanted wanted) const {
    const TileOrder order = order_by_tile(block, {}, setup_.shape, setup_.geometry.cell_rad, wanted, setup_.threads);
    std::vector<std::complex<double>> visibility(block.samples());
    const std::vector<const Real*> planes{grid_.real.data(), grid_.imaginary.data()};
    std::vector<TileTask> tasks;
    for (const std::vector<TileTask>& colour : coloured_tasks(order, setup_.shape))
      tasks.insert(tasks.end(), colour.begin(), colour.end());
    parallel_for(tasks.size(), setup_.threads, [&](std::size_t i) {
      const bool in_place = sparse(order, tasks[i]);
      TileBuffer<Real> buffer(setup_.shape.tile, setup_.taps_u.padded, in_place ? 0 : 2);
      if (!in_place) load(tasks[i], buffer);
      const TileCells<const Real> cells =
          in_place ? cells_of(setup_.shape, tasks[i], planes) : TileCells<const Real>(buffer.cells());
      if (i + 1 < tasks.size() && !sparse(order, tasks[i + 1]))
        for (const Real* plane : planes) prefetch_tile(setup_.shape, tasks[i + 1], plane);
      const auto ahead = [&](std::size_t sample) { hwy::Prefetch(&visibility[sample]); };
      const auto done = [&](TileBatch<Real>& batch, const BatchSamples& samples) {
        interpolate(setup_.taps_u, setup_.taps_v, cells, batch);
        for (int k = 0; k < batch.count; ++k) {
          const double imaginary = double{batch.value[1][k]};
          visibility[samples.index[k]] =
              samples.from_phase_centre({double{batch.value[0][k]}, samples.conjugate[k] ? imaginary : -imaginary}, k);
        }
      };
      for_each_batch<Real>(setup_.geometry, setup_.shape, block, order, tasks[i], ahead, done);
    });
    return visibility;
  }

  void load(const TileTask& task, TileBuffer<Real>& buffer) const {
    const int reach = setup_.shape.tile + setup_.shape.width - 1;
    for (int r = 0; r < reach; ++r) {
      const std::size_t start = first_cell(setup_.shape, task, r);
      std::copy_n(grid_.real.data() + start, reach, buffer.row(r, 0));
      std::copy_n(grid_.imaginary.data() + start, reach, buffer.row(r, 1));
    }
  }

  const Setup<Real>& setup_;
  HalfGrid<Real> grid_;
  double fft_s_ = 0;
};

GridShape shape_of(const PlaneTransformOptions& o) {
  return {o.nu, o.nv, o.kernel_u.width(), tile_side};
}

template <typename Real>
class PlaneTransform : public Transform {
 public:
  explicit PlaneTransform(const PlaneTransformOptions& o)
      : setup_{o.geometry,
               shape_of(o),
               TapTable<Real>(o.kernel_u.polynomial, o.lookup),
               TapTable<Real>(o.kernel_v.polynomial, o.lookup),
               {axis_correction(o.kernel_u, o.geometry.width, o.nu), axis_correction(o.kernel_v, o.geometry.height, o.nv)},
               o.threads} {}

  std::unique_ptr<AdjointSum> adjoint(const AdjointOptions& options) const override {
    return std::make_unique<PlaneAdjoint<Real>>(setup_, options);
  }
  std::unique_ptr<Prediction> predict(const Image& model) const override {
    return std::make_unique<PlanePrediction<Real>>(setup_, model);
  }

 private:
  Setup<Real> setup_;
};

void check_axis(const char* axis, int pixels, int fft_size, const kernels::Kernel& kernel) {
  if (fft_size % 2 != 0 || fft_size < pixels || fft_size < 4 * kernel.width())
    throw std::invalid_argument("FFT length " + std::to_string(fft_size) + " along " + axis +
                                " is not even, below the image's " + std::to_string(pixels) +
                                " pixels, or below 4 kernel widths");
  const double x0 = static_cast<double>(pixels / 2) / fft_size;
  if (kernel.x0 < x0 - 1e-12)
    throw std::invalid_argument("kernel made for x0 = " + std::to_string(kernel.x0) + " along " + axis +
                                ", but the image reaches " + std::to_string(x0));
}

}  // namespace

std::unique_ptr<Transform> make_plane_transform(const PlaneTransformOptions& options) {
  check_axis("u", options.geometry.width, options.nu, options.kernel_u);
  check_axis("v", options.geometry.height, options.nv, options.kernel_v);
  if (options.kernel_u.width() != options.kernel_v.width())
    throw std::invalid_argument("kernels of widths " + std::to_string(options.kernel_u.width()) + " along u and " +
                                std::to_string(options.kernel_v.width()) + " along v; one width is expected");
  if (options.precision == Precision::single_precision) return std::make_unique<PlaneTransform<float>>(options);
  return std::make_unique<PlaneTransform<double>>(options);
}

double longest_plane_sum(Precision precision, double samples) {
  const bool single = precision == Precision::single_precision;
  const double in_grid = single ? std::min<double>(samples, most_in_single) : samples;
  return std::min<double>(samples, most_in_registers + most_in_buffer / most_in_registers + in_grid / most_in_buffer);
}

TransformMemory memory_of(const PlaneTransformOptions& o, int stokes, double samples) {
  const bool single = o.precision == Precision::single_precision;
  const double real_bytes = single ? sizeof(float) : sizeof(double);
  const GridShape shape = shape_of(o);
  const double tiles = static_cast<double>(shape.tiles_u()) * static_cast<double>(shape.tiles_v());
  const double crowded = single ? std::min(tiles, samples / most_in_single) : 0;
  const double side = shape.tile + padded_taps<float>(shape.width);
  const double plane = static_cast<double>(shape.cells()) * real_bytes + crowded * side * side * sizeof(double);
  return {2 * plane, plane, transform_buffer_bytes(shape, o.threads, real_bytes), 2 * plane * (stokes - 1), 0};
}

}  // namespace misfit::imager
