#include "imager/wide_transform.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "imager/horizon.h"
#include "imager/parallel.h"
#include "imager/phase.h"
#include "imager/phasors.h"
#include "imager/sampling.h"
#include "imager/span_sums.h"
#include "imager/spares.h"
#include "imager/stack_columns.h"
#include "imager/stack_loops.h"
#include "imager/stack_rows.h"
#include "imager/stack_walk.h"
#include "imager/stage_times.h"
#include "imager/sum_unit.h"
#include "imager/touched_cells.h"

namespace misfit::imager {
namespace {

template <typename Real>
struct Setup {
  WideTransformOptions options;
  StackShape shape;
  StackTaps<Real> taps;
  std::vector<StackedFacet> facets;  ///< those that reach above the horizon

  StackOrderOptions ordering(const StackedFacet& f) const {
    return {shape, taps.w.width, StackScale(shape, f.facet, f.plane_step), options.threads};
  }
};

StackShape shape_of(const WideTransformOptions& o) {
  constexpr int tile = 32;
  return {o.nu, o.nv, o.kernel_u.width(), std::max(tile, o.kernel_u.width())};
}

template <typename Real>
Setup<Real> set_up(const WideTransformOptions& o) {
  Setup<Real> s{o,
                shape_of(o),
                {TapTable<Real>(o.kernel_u.polynomial, o.lookup), TapTable<Real>(o.kernel_v.polynomial, o.lookup),
                 TapTable<Real>(o.kernel_w.polynomial, o.lookup)},
                {}};
  const SmoothCorrection h_w(o.kernel_w);
  for (const Facet& facet : split_into_facets(o.geometry, o.facets_l, o.facets_m)) {
    if (facet.empty) continue;
    constexpr double flat = 1e-15;  // a facet of one pixel has no curvature
    s.facets.push_back({facet, o.kernel_w.x0 / std::max(facet.reach, flat),
                        axis_correction(o.kernel_u, facet.geometry.width, o.nu),
                        axis_correction(o.kernel_v, facet.geometry.height, o.nv), h_w});
  }
  return s;
}

// Of a prediction: both halves of its visibilities; and at worst a run each for a sample and its mirror image, twice while they
// are sorted. An adjoint takes less.
static_assert(wide_bytes_a_sample == 2 * sizeof(std::complex<double>) + 2 * (2 * sizeof(StackRun) + 8));

/// Planes of one facet that memory can hold.
template <typename Real>
int most_planes(const Setup<Real>& setup, int grids) {
  const double plane_bytes = grids * static_cast<double>(setup.shape.cells()) * sizeof(std::complex<Real>);
  return std::max(1, static_cast<int>(static_cast<double>(setup.options.stack_bytes) / plane_bytes));
}

/// Calls visit(row, chunk, plane, grid, cells) for what a tile's buffer and a stack share, in the stack's order.
template <typename Visit>
void for_each_chunk(const StackShape& s, const StackTask& task, int grids, const Visit& visit) {
  const int reach = s.tile + s.width - 1;
  for (int row = 0; row < reach; ++row)
    for (int chunk = 0; chunk < 2; ++chunk)
      for (int plane = 0; plane < task.planes.planes; ++plane)
        for (int grid = 0; grid < grids; ++grid) visit(row, chunk, plane, grid, std::min(s.tile, reach - chunk * s.tile));
}

template <typename Real>
StackBuffer<Real> buffer_of(const Setup<Real>& setup, int grids) {
  return StackBuffer<Real>(setup.shape.tile, setup.shape.width, grids);
}

/// Sums in single precision stay short: a buffer is added to the stack after so many samples.
constexpr int most_in_buffer = 1024;
/// Equal terms err to one side, by up to 2⁻²⁵ of the sum each: fewer of them in single precision where a cell takes them all.
constexpr int most_in_single_cell = 32;

/// A tile of no more samples is gridded and degridded where it lies in the stack: a buffer costs more to bring and to add.
/// Measured: from some 800 samples on, the buffer's nearness to the processor wins.
constexpr std::size_t most_in_place = 512;
bool sparse(const StackOrder& order, const StackTask& task) {
  if (task.end - task.begin > most_in_place) return false;
  std::size_t samples = 0;
  for (std::size_t r = task.begin; r < task.end; ++r) samples += order.run[r].count;
  return samples <= most_in_place;
}

/// Adds what a step takes to a total.
template <typename Step>
void add_seconds_of(double& total, const Step& step) {
  const Stopwatch watch;
  step();
  total += watch.seconds();
}

template <typename Real>
class WideAdjoint : public AdjointSum {
 public:
  WideAdjoint(const Setup<Real>& setup, bool with_psf)
      : setup_(setup), with_psf_(with_psf && !beyond_horizon(setup.options.geometry.centre)) {
    const ImageGeometry& g = setup.options.geometry;
    result_.image = Image(g.width, g.height);
    if (with_psf) result_.psf = Image(g.width, g.height);
  }

  void add(const VisibilityBlock& block) override { gather(block, block.visibility); }
  void add(const VisibilityBlock& block, const std::vector<std::complex<double>>& visibility) override {
    gather(block, visibility);
  }
  AdjointResult finish() override {
    flush();
    multiply(result_.image, value_unit_.unit());
    multiply(result_.psf, weight_unit_.unit());
    set_beyond_horizon(setup_.options.geometry, no_value, result_.image);
    if (with_psf_) {
      set_beyond_horizon(setup_.options.geometry, no_value, result_.psf);
    } else {
      std::fill(result_.psf.pixel.begin(), result_.psf.pixel.end(), no_value);
    }
    return std::move(result_);
  }

 private:
  /// A block's samples, those left out with weight 0.
  struct Gathered {
    SampleCoordinates at;
    std::vector<float> weight;
    std::vector<std::complex<Real>> weighted;  ///< weight · V, in the values' unit
  };

  static void multiply(Image& image, double by) {
    if (by != 1)
      for (double& pixel : image.pixel) pixel *= by;
  }

  /// Calls visit(piece, begin, end) for the pieces of [0, samples), shared among threads.
  template <typename Visit>
  void for_pieces(std::size_t samples, const Visit& visit) const {
    parallel_for(pieces(samples), setup_.options.threads,
                 [&](std::size_t p) { visit(p, p * samples_a_piece, std::min((p + 1) * samples_a_piece, samples)); });
  }
  static std::size_t pieces(std::size_t samples) { return (samples + samples_a_piece - 1) / samples_a_piece; }
  static constexpr std::size_t samples_a_piece = 1 << 16;

  template <typename Visibility>
  SampleSums sums_of(const std::vector<float>& weight, const Visibility& visibility) const {
    std::vector<SampleSums> part(pieces(weight.size()));
    for_pieces(weight.size(), [&](std::size_t p, std::size_t begin, std::size_t end) {
      add_span_to_sums(weight.data() + begin, visibility.data() + begin, end - begin, part[p]);
    });
    SampleSums sums;
    for (const SampleSums& of_piece : part) sums += of_piece;
    return sums;
  }

  /// Brings the images to the units that hold the samples to come too. What was gathered in others is gridded first.
  void make_room(const SampleSums& coming) {
    SumUnit<Real> value_unit = value_unit_, weight_unit = weight_unit_;
    const double values = value_unit.make_room(coming.weight_abs), weights = weight_unit.make_room(coming.weight);
    if (values != 1 || weights != 1) {
      flush();
      multiply(result_.image, values);
      multiply(result_.psf, weights);
    }
    value_unit_ = value_unit;
    weight_unit_ = weight_unit;
  }

  template <typename Visibility>
  void gather(const VisibilityBlock& block, const Visibility& visibility) {
    const double cell_rad = setup_.options.geometry.cell_rad;
    Gathered g{block, imaging_weights(block, cell_rad, setup_.options.threads, result_.sums), {}};
    const SampleSums sums = sums_of(g.weight, visibility);
    result_.sums += sums;
    make_room(sums);
    g.weighted.resize(g.weight.size());
    const double per_unit = value_unit_.per_unit();
    for_pieces(g.weight.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        if (g.weight[i] != 0)
          g.weighted[i] = std::complex<Real>(double{g.weight[i]} * per_unit * std::complex<double>(visibility[i]));
    });
    samples_ += block.samples();
    gathered_.push_back(std::move(g));
    if (samples_ >= setup_.options.samples_at_once) flush();
  }

  void flush() {
    if (gathered_.empty()) return;
    std::vector<WantedSamples> blocks;
    for (const Gathered& g : gathered_) blocks.push_back({&g.at, g.weight.data()});
    std::vector<Image*> images{&result_.image};
    if (with_psf_) images.push_back(&result_.psf);
    const int grids = static_cast<int>(images.size()), threads = setup_.options.threads;
    PlaneStack<Real> stack(setup_.shape, grids);
    Spares<StackBuffer<Real>> spares;
    for (const StackedFacet& f : setup_.facets) {
      const StackOrderOptions ordering = setup_.ordering(f);
      const StackOrder order = order_for_stack(blocks, ordering);
      for (const Slab& slab : slabs_of(order, most_planes(setup_, grids))) {
        stack.reserve(slab.planes);
        StackRows<Real> rows(stack, f.facet.geometry.width, threads);
        for (const Band& band : bands_of(setup_.shape, stack.bytes_a_row())) {
          const auto colours = tasks_of(order, setup_.shape, slab, ordering.width_w, band);
          stack.use_rows(rows_of(colours), threads);
          for (const std::vector<StackTask>& tasks : colours)
            parallel_for(tasks.size(), threads, [&](std::size_t i) {
              auto buffer = spares.take([&] { return std::make_unique<StackBuffer<Real>>(buffer_of(setup_, grids)); });
              grid_tile({blocks, order, ordering}, tasks[i], slab.first, *buffer, stack);
              spares.give_back(std::move(buffer));
            });
          add_seconds_of(result_.fft_s, [&] { rows.to_image(band.end * setup_.shape.tile); });
        }
        add_seconds_of(result_.fft_s, [&] {
          rows.to_image(setup_.shape.rows());
          stack_to_images(stack, f, slab.first, threads, images);
        });
      }
    }
    gathered_.clear();
    samples_ = 0;
  }

  std::vector<RowRange> rows_of(const std::vector<std::vector<StackTask>>& colours) const {
    const StackShape& s = setup_.shape;
    std::vector<RowRange> rows;
    for (const std::vector<StackTask>& tasks : colours)
      for (const StackTask& task : tasks) rows.push_back({task.tile_v * s.tile, (task.tile_v + 1) * s.tile + s.width - 1});
    return rows;
  }

  void grid_tile(const StackSamples& samples, const StackTask& task, int first_plane, StackBuffer<Real>& buffer,
                 PlaneStack<Real>& stack) const {
    bool in_place = sparse(samples.order, task);
    if (!in_place) buffer.reset(task.planes.planes);
    TileSum sum{buffer, TouchedCells<Real>(setup_.taps, buffer, task.planes.planes), {}};
    const auto of_stack = stack.cells_of(task.tile_u, task.tile_v, task.planes.first - first_plane, task.planes.planes);
    const auto ahead = [&](std::uint32_t block, std::size_t sample) { hwy::Prefetch(&gathered_[block].weighted[sample]); };
    const auto done = [&](StackBatch<Real>& batch, BatchPhases& phases) {
      // The grid holds conj(V), whose backward transform is the image; see plane_stack.h for the axes. The V of a mirror image
      // is the conjugate already.
      for (const BatchRun& run : phases.run) {
        const std::complex<Real>* weighted = &gathered_[run.block].weighted[run.sample];
        const double sign = run.mirrored ? 1 : -1;
        for (int k = run.begin; k < run.end; ++k, ++weighted) {
          const double re = double{weighted->real()}, im = sign * double{weighted->imag()};
          batch.value[0][k] = {static_cast<Real>(re * phases.cosine[k] - im * phases.sine[k]),
                               static_cast<Real>(re * phases.sine[k] + im * phases.cosine[k])};
        }
      }
      if (buffer.grids == 2) set_psf_values(phases, batch);
      sum.touched.add(batch);
      if (in_place && sum.is_dense()) {
        in_place = false;
        buffer.reset(task.planes.planes);
      }
      spread(setup_.taps, batch, in_place ? of_stack : buffer.cells());
      if (!in_place && (sum.touched.samples() >= most_in_buffer || sum.is_dense())) empty_buffer(task, first_plane, sum, stack);
      phases.most = sum.exact ? most_in_single_cell : BatchPhases::capacity;
    };
    for_each_batch<Real>(samples, task, ahead, done, most_in_single_cell);  // the first batch shows whether samples crowd
    if (!in_place && sum.touched.samples() > 0) empty_buffer(task, first_plane, sum, stack);
    if (sum.exact) flush_buffer(task, first_plane, *sum.exact, stack);
  }

  /// The sum of a tile: a buffer, and what was added up in double precision before.
  struct TileSum {
    StackBuffer<Real>& buffer;
    TouchedCells<Real> touched;                ///< since the buffer was emptied
    std::optional<StackBuffer<double>> exact;  ///< where samples crowd

    bool is_dense() const { return std::is_same_v<Real, float> && touched.samples_a_cell() >= most_in_single_cell; }
  };

  /// Where samples crowd, sums go on in double precision.
  void empty_buffer(const StackTask& task, int first_plane, TileSum& sum, PlaneStack<Real>& stack) const {
    if (sum.is_dense() && !sum.exact) {
      sum.exact.emplace(setup_.shape.tile, setup_.shape.width, sum.buffer.grids);
      sum.exact->reset(task.planes.planes);
    }
    if (sum.exact) {
      move(sum.touched, sum.buffer, *sum.exact);
    } else {
      flush_buffer(task, first_plane, sum.buffer, stack);
      sum.buffer.reset(task.planes.planes);
    }
    sum.touched.clear();
  }

  static void move(const TouchedCells<Real>& touched, StackBuffer<Real>& buffer, StackBuffer<double>& to) {
    for (int plane = touched.plane.begin; plane < touched.plane.end; ++plane)
      for (int row = touched.row.begin; row < touched.row.end; ++row)
        for (int grid = 0; grid < buffer.grids; ++grid) {
          std::complex<Real>* const from = buffer.row(plane, row, grid);
          std::complex<double>* const sum = to.row(plane, row, grid);
          for (int c = touched.column.begin; c < touched.column.end; ++c) {
            sum[c] += std::complex<double>(from[c]);
            from[c] = 0;
          }
        }
  }

  template <typename Sum>
  void flush_buffer(const StackTask& task, int first_plane, const StackBuffer<Sum>& buffer, PlaneStack<Real>& stack) const {
    const StackShape& s = setup_.shape;
    for_each_chunk(s, task, stack.grids, [&](int row, int chunk, int plane, int grid, int count) {
      const std::complex<Sum>* const from = buffer.row(plane, row, grid) + chunk * s.tile;
      std::complex<Real>* const to =
          stack.chunk(task.tile_v * s.tile + row, task.tile_u + chunk, task.planes.first - first_plane + plane, grid);
      if constexpr (std::is_same_v<Sum, Real>)
        add_cells(from, count, to);
      else
        for (int c = 0; c < count; ++c) to[c] = std::complex<Real>(std::complex<double>(to[c]) + from[c]);
    });
  }

  void weigh_psf(const BatchPhases& phases, const double* cosine, const double* sine, StackBatch<Real>& batch) const {
    const double per_unit = weight_unit_.per_unit();
    for (const BatchRun& run : phases.run)
      for (int k = run.begin; k < run.end; ++k) {
        const double weight = per_unit * gathered_[run.block].weight[run.sample + static_cast<std::size_t>(k - run.begin)];
        batch.value[1][k] = {static_cast<Real>(weight * cosine[k]), static_cast<Real>(weight * sine[k])};
      }
  }

  /// Those of a source of 1 Jy in the image's middle pixel, seen from the facet's.
  void set_psf_values(const BatchPhases& phases, StackBatch<Real>& batch) const {
    const ImageGeometry& g = setup_.options.geometry;
    if (!g.off_phase_centre()) return weigh_psf(phases, phases.cosine, phases.sine, batch);
    const PhasePosition middle = phase_position(g.centre);
    double turns[BatchPhases::capacity], cosine[BatchPhases::capacity], sine[BatchPhases::capacity];
    for (const BatchRun& run : phases.run) {
      const SampleCoordinates& at = gathered_[run.block].at;
      const std::size_t row = run.sample / at.channels(), channel = run.sample % at.channels();
      const double to_middle = turns_per_hz(&at.uvw_m[3 * row], middle) * (run.mirrored ? -1 : 1);
      for (int k = run.begin; k < run.end; ++k)
        turns[k] = phases.turns[k] - to_middle * at.frequency_hz[channel + static_cast<std::size_t>(k - run.begin)];
    }
    phasors(turns, batch.count, cosine, sine);
    weigh_psf(phases, cosine, sine, batch);
  }

  const Setup<Real>& setup_;
  bool with_psf_;  ///< whose source is above the horizon
  std::vector<Gathered> gathered_;
  std::size_t samples_ = 0;
  SumUnit<Real> value_unit_;   ///< of the image
  SumUnit<Real> weight_unit_;  ///< of the PSF
  AdjointResult result_;
};

template <typename Real>
class WidePrediction : public Prediction {
 public:
  WidePrediction(const Setup<Real>& setup, const Image& model) : setup_(setup), model_(model) {}

  std::vector<std::complex<double>> at(const SampleCoordinates& coordinates) const override {
    return degrid({{&coordinates}}).front();
  }
  std::vector<std::complex<double>> at_usable(const VisibilityBlock& block) const override {
    return at_usable_of({&block}).front();
  }
  std::vector<std::vector<std::complex<double>>> at_usable_of(
      const std::vector<const VisibilityBlock*>& blocks) const override {
    std::vector<WantedSamples> usable;
    for (const VisibilityBlock* block : blocks) usable.push_back({block, block->weight.data()});
    return degrid(usable);
  }
  std::size_t samples_at_once() const override { return setup_.options.samples_at_once; }
  double fft_s() const override { return fft_s_; }

 private:
  using Visibilities = std::vector<std::vector<std::complex<double>>>;  ///< [block][sample]

  /// What samples and their mirror images gather in different tiles, by different threads.
  struct Halves {
    Visibilities direct;
    Visibilities mirrored;
  };

  Visibilities degrid(const std::vector<WantedSamples>& blocks) const {
    Halves halves;
    for (const WantedSamples& block : blocks) halves.direct.emplace_back(block.at->samples());
    halves.mirrored = halves.direct;
    const int threads = setup_.options.threads;
    PlaneStack<Real> stack(setup_.shape, 1);
    Spares<StackBuffer<Real>> spares;
    for (const StackedFacet& f : setup_.facets) {
      const StackOrderOptions ordering = setup_.ordering(f);
      const StackOrder order = order_for_stack(blocks, ordering);
      for (const Slab& slab : slabs_of(order, most_planes(setup_, 1))) {
        stack.reserve(slab.planes);
        add_seconds_of(fft_s_, [&] { image_to_stack(model_, f, slab.first, threads, stack); });
        StackRows<Real> rows(stack, f.facet.geometry.width, threads);
        for (const Band& band : bands_of(setup_.shape, stack.bytes_a_row())) {
          add_seconds_of(fft_s_, [&] { rows.to_grid(band.end * setup_.shape.tile + setup_.shape.width); });
          for (const std::vector<StackTask>& tasks : tasks_of(order, setup_.shape, slab, ordering.width_w, band))
            parallel_for(tasks.size(), threads, [&](std::size_t i) {
              auto buffer = spares.take([&] { return std::make_unique<StackBuffer<Real>>(buffer_of(setup_, 1)); });
              degrid_tile({blocks, order, ordering}, tasks[i], slab.first, stack, *buffer, halves);
              spares.give_back(std::move(buffer));
            });
        }
      }
    }
    for (std::size_t b = 0; b < blocks.size(); ++b)
      for (std::size_t i = 0; i < halves.direct[b].size(); ++i) halves.direct[b][i] += std::conj(halves.mirrored[b][i]);
    return std::move(halves.direct);
  }

  void degrid_tile(const StackSamples& samples, const StackTask& task, int first_plane, const PlaneStack<Real>& stack,
                   StackBuffer<Real>& buffer, Halves& halves) const {
    const StackShape& s = setup_.shape;
    StackCells<const std::complex<Real>> cells =
        stack.cells_of(task.tile_u, task.tile_v, task.planes.first - first_plane, task.planes.planes);
    if (!sparse(samples.order, task)) {
      buffer.reset(task.planes.planes);
      for_each_chunk(s, task, 1, [&](int row, int chunk, int plane, int grid, int count) {
        std::copy_n(stack.chunk(task.tile_v * s.tile + row, task.tile_u + chunk, task.planes.first - first_plane + plane, grid),
                    count, buffer.row(plane, row, grid) + chunk * s.tile);
      });
      cells = buffer.cells();
    }
    const auto ahead = [](std::uint32_t, std::size_t) {};
    for_each_batch<Real>(samples, task, ahead, [&](StackBatch<Real>& batch, const BatchPhases& phases) {
      interpolate(setup_.taps, cells, batch);
      for (const BatchRun& run : phases.run) {
        std::complex<double>* visibility = &(run.mirrored ? halves.mirrored : halves.direct)[run.block][run.sample];
        for (int k = run.begin; k < run.end; ++k, ++visibility) {
          const double re = double{batch.value[0][k].real()}, im = double{batch.value[0][k].imag()};
          *visibility +=
              std::complex<double>(re * phases.cosine[k] + im * phases.sine[k], re * phases.sine[k] - im * phases.cosine[k]);
        }
      }
    });
  }

  const Setup<Real>& setup_;
  Image model_;
  mutable double fft_s_ = 0;
};

template <typename Real>
class WideTransform : public Transform {
 public:
  explicit WideTransform(const WideTransformOptions& options) : setup_(set_up<Real>(options)) {}

  std::unique_ptr<AdjointSum> adjoint(bool with_psf) const override {
    return std::make_unique<WideAdjoint<Real>>(setup_, with_psf);
  }
  std::unique_ptr<Prediction> predict(const Image& model) const override {
    return std::make_unique<WidePrediction<Real>>(setup_, model);
  }

 private:
  Setup<Real> setup_;
};

void check_axis(const char* axis, int pixels, int fft_size, const kernels::Kernel& kernel) {
  if (fft_size < pixels || fft_size < 4 * kernel.width())
    throw std::invalid_argument("FFT length " + std::to_string(fft_size) + " along " + axis + " is below the facets' " +
                                std::to_string(pixels) + " pixels, or below 4 kernel widths");
  const double x0 = static_cast<double>(pixels / 2) / fft_size;
  if (kernel.x0 < x0 - 1e-12)
    throw std::invalid_argument("kernel made for x0 = " + std::to_string(kernel.x0) + " along " + axis +
                                ", but the facets reach " + std::to_string(x0));
}

int largest_part(int pixels, int parts) {
  return (pixels + parts - 1) / parts;
}

}  // namespace

std::unique_ptr<Transform> make_wide_transform(const WideTransformOptions& o) {
  if (o.facets_l < 1 || o.facets_m < 1 || o.facets_l > o.geometry.width || o.facets_m > o.geometry.height)
    throw std::invalid_argument(std::to_string(o.facets_l) + " × " + std::to_string(o.facets_m) + " facets of an image of " +
                                std::to_string(o.geometry.width) + " × " + std::to_string(o.geometry.height) + " pixels");
  check_axis("u", largest_part(o.geometry.width, o.facets_l), o.nu, o.kernel_u);
  check_axis("v", largest_part(o.geometry.height, o.facets_m), o.nv, o.kernel_v);
  if (o.kernel_u.width() != o.kernel_v.width())
    throw std::invalid_argument("kernels of widths " + std::to_string(o.kernel_u.width()) + " along u and " +
                                std::to_string(o.kernel_v.width()) + " along v; one width is expected");
  if (o.precision == Precision::single_precision) return std::make_unique<WideTransform<float>>(o);
  return std::make_unique<WideTransform<double>>(o);
}

TransformMemory memory_of(const WideTransformOptions& o, double samples, int planes) {
  const bool single = o.precision == Precision::single_precision;
  const double complex_bytes = single ? sizeof(std::complex<float>) : sizeof(std::complex<double>);
  const double gathered = std::min(samples, static_cast<double>(o.samples_at_once)) * wide_bytes_a_sample;
  const double plane = static_cast<double>(shape_of(o).cells()) * complex_bytes;
  const double image = static_cast<double>(o.geometry.pixels()) * sizeof(double);
  const double one = std::min(planes * plane, std::max(plane, static_cast<double>(o.stack_bytes)));
  const double both = std::min(2 * planes * plane, std::max(2 * plane, static_cast<double>(o.stack_bytes)));
  const double column = 6.0 * largest_part(o.geometry.height, o.facets_m) * sizeof(double) + o.nv * complex_bytes;
  return {gathered + one + image, both - one + image, o.threads * 16 * column};
}

double longest_sum(const WideTransformOptions& options, double samples) {
  if (!options.has_w_axis()) return longest_plane_sum(options.precision, samples);
  return std::min(samples, most_in_buffer + samples / most_in_buffer);
}

std::unique_ptr<Transform> make_transform(const WideTransformOptions& options) {
  return options.has_w_axis() ? make_wide_transform(options) : make_plane_transform(options);
}

}  // namespace misfit::imager
