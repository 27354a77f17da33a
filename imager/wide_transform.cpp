#include "imager/wide_transform.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "imager/horizon.h"
#include "imager/parallel.h"
#include "imager/phase.h"
#include "imager/phasors.h"
#include "imager/sampling.h"
#include "imager/stack_loops.h"
#include "imager/stack_order.h"
#include "imager/tile_order.h"

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
  Setup<Real> s{
      o,
      shape_of(o),
      {TapTable<Real>(o.kernel_u.polynomial), TapTable<Real>(o.kernel_v.polynomial), TapTable<Real>(o.kernel_w.polynomial)},
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

/// Neighbouring planes that are held at a time.
struct Slab {
  int first = 0;
  int planes = 0;
};

/// The planes that hold anything, as many at a time as memory allows.
template <typename Real>
std::vector<Slab> slabs_of(const StackOrder& order, const Setup<Real>& setup, int width, int components) {
  const double plane_bytes = bytes_a_plane<Real>(setup.shape, components, width);
  const int most = std::max(1, static_cast<int>(static_cast<double>(setup.options.stack_bytes) / plane_bytes));
  std::vector<Slab> slabs;
  for (std::size_t k = 0; k < order.plane_used.size(); ++k) {
    if (order.plane_used[k] == 0) continue;
    const int plane = static_cast<int>(k);
    if (slabs.empty() || slabs.back().planes == most || slabs.back().first + slabs.back().planes != plane)
      slabs.push_back({plane, 0});
    ++slabs.back().planes;
  }
  return slabs;
}

/// A tile's runs that reach into a slab, and the planes of it that they touch.
struct StackTask {
  int tile_u;
  int tile_v;
  std::size_t begin;
  std::size_t end;
  Slab planes;
};

/// In four colours of tiles whose buffers cannot touch, the fullest of a colour first.
std::vector<std::vector<StackTask>> tasks_of(const StackOrder& order, const StackShape& shape, const Slab& slab, int width_w) {
  std::vector<std::vector<StackTask>> colours(4);
  const auto below = [](const StackRun& run, int plane) { return run.plane < plane; };
  std::size_t tile = 0;
  for (int v = 0; v < shape.tiles_v(); ++v)
    for (int u = 0; u < shape.tiles_u(); ++u, ++tile) {
      const auto first = order.run.begin() + static_cast<std::ptrdiff_t>(order.begin[tile]);
      const auto last = order.run.begin() + static_cast<std::ptrdiff_t>(order.begin[tile + 1]);
      if (first == last) continue;
      const auto begin = std::lower_bound(first, last, slab.first - width_w + 1, below);
      const auto end = std::lower_bound(begin, last, slab.first + slab.planes, below);
      if (begin == end) continue;
      const int lowest = std::max(begin->plane, slab.first);
      const int highest = std::min((end - 1)->plane + width_w, slab.first + slab.planes);
      colours[static_cast<std::size_t>(v % 2 * 2 + u % 2)].push_back({u,
                                                                      v,
                                                                      static_cast<std::size_t>(begin - order.run.begin()),
                                                                      static_cast<std::size_t>(end - order.run.begin()),
                                                                      {lowest, highest - lowest}});
    }
  for (std::vector<StackTask>& tasks : colours)
    std::stable_sort(tasks.begin(), tasks.end(),
                     [](const StackTask& a, const StackTask& b) { return a.end - a.begin > b.end - b.begin; });
  return colours;
}

/// What a batch needs to know of its samples besides their places.
struct BatchPhases {
  static constexpr int capacity = StackBatch<double>::capacity;
  std::size_t block[capacity];
  std::size_t sample[capacity];
  bool mirrored[capacity];
  double turns[capacity];
  double cosine[capacity];
  double sine[capacity];
};

/// Where the taps of a sample lie in its tile along one axis. A sample on the edge of two cells stays within the tile that it
/// was put in, however its position is rounded.
struct TileTap {
  int first = 0;
  double t = 0;

  TileTap(double cells, int tile, const StackShape& s) {
    const int origin = tile * s.tile - s.margin();
    first = std::clamp(TapPosition(cells, s.width).first - origin, 0, s.tile - 1);
    t = cells - (first + origin) - 0.5 * (s.width - 1);
  }
};

/// Walks through a task's samples in batches: done(batch, phases) for each, phases computed.
template <typename Real, typename Done>
void for_each_batch(const Setup<Real>& setup, const StackScale& scale, const std::vector<const SampleCoordinates*>& blocks,
                    const StackOrder& order, const StackTask& task, const Done& done) {
  const StackShape& s = setup.shape;
  StackBatch<Real> batch;
  BatchPhases phases;
  const auto finish = [&] {
    phasors(phases.turns, batch.count, phases.cosine, phases.sine);
    done(batch, phases);
    batch.count = 0;
  };
  for (std::size_t i = task.begin; i < task.end; ++i) {
    const StackRun run = order.run[i];
    const SampleCoordinates& at = *blocks[run.block];
    const StackRow row(&at.uvw_m[std::size_t{3} * run.row], run.mirrored != 0, scale);
    for (std::size_t channel = run.first; channel < std::size_t{run.first} + run.count; ++channel) {
      const double frequency = at.frequency_hz[channel];
      const TileTap u(reduced(row.u_per_hz * frequency, s.nu), task.tile_u, s);
      const TileTap v(reduced(row.v_per_hz * frequency, s.nv), task.tile_v, s);
      const int k = batch.count++;
      batch.plane[k] = run.plane - task.planes.first;
      batch.column[k] = u.first;
      batch.row[k] = v.first;
      batch.tu[k] = static_cast<Real>(u.t);
      batch.tv[k] = static_cast<Real>(v.t);
      batch.tw[k] = static_cast<Real>(row.along_w(frequency, setup.taps.w.width).t);
      phases.block[k] = run.block;
      phases.sample[k] = run.row * at.channels() + channel;
      phases.mirrored[k] = run.mirrored != 0;
      phases.turns[k] = row.turns_per_hz * frequency;
      if (batch.count == StackBatch<Real>::capacity) finish();
    }
  }
  if (batch.count > 0) finish();
}

/// Calls visit(row, chunk, plane, component, cells) for what a tile's buffer and a stack share, in the stack's order.
template <typename Visit>
void for_each_chunk(const StackShape& s, const StackTask& task, int components, const Visit& visit) {
  const int reach = s.tile + s.width - 1;
  for (int row = 0; row < reach; ++row)
    for (int chunk = 0; chunk < 2; ++chunk)
      for (int plane = 0; plane < task.planes.planes; ++plane)
        for (int component = 0; component < components; ++component)
          visit(row, chunk, plane, component, std::min(s.tile, reach - chunk * s.tile));
}

/// Sums in single precision stay short: a buffer is added to the stack after so many samples.
constexpr int most_in_buffer = 512;

template <typename Real>
class WideAdjoint : public AdjointSum {
 public:
  WideAdjoint(const Setup<Real>& setup, bool with_psf) : setup_(setup) {
    const ImageGeometry& g = setup.options.geometry;
    result_.image = Image(g.width, g.height);
    if (with_psf) result_.psf = Image(g.width, g.height);
  }

  void add(const VisibilityBlock& block) override {
    std::vector<std::complex<double>> none;
    gather({block, std::move(none)});
  }
  void add(const VisibilityBlock& block, const std::vector<std::complex<double>>& visibility) override {
    Gathered g{block, visibility};
    g.block.visibility.clear();
    gather(std::move(g));
  }
  AdjointResult finish() override {
    flush();
    set_beyond_horizon(setup_.options.geometry, no_value, result_.image);
    if (!result_.psf.pixel.empty()) set_beyond_horizon(setup_.options.geometry, no_value, result_.psf);
    return std::move(result_);
  }

 private:
  /// A block whose samples beyond the grid have weight 0, and the visibilities given in place of its own.
  struct Gathered {
    VisibilityBlock block;
    std::vector<std::complex<double>> other;

    std::complex<double> visibility(std::size_t i) const {
      return other.empty() ? std::complex<double>(block.visibility[i]) : other[i];
    }
  };

  void gather(Gathered g) {
    const std::vector<char> inside = samples_inside(g.block, setup_.options.geometry.cell_rad, result_.sums);
    for (std::size_t i = 0; i < inside.size(); ++i) {
      if (inside[i]) {
        add_to_sums(result_.sums, g.block.weight[i], g.visibility(i));
      } else {
        g.block.weight[i] = 0;
      }
    }
    samples_ += g.block.samples();
    gathered_.push_back(std::move(g));
    if (samples_ >= setup_.options.samples_at_once) flush();
  }

  void flush() {
    std::vector<const SampleCoordinates*> blocks;
    for (const Gathered& g : gathered_) blocks.push_back(&g.block);
    std::vector<Image*> images{&result_.image};
    if (!result_.psf.pixel.empty()) images.push_back(&result_.psf);
    const int components = 2 * static_cast<int>(images.size());
    const auto wanted = [&](std::size_t block, std::size_t i) { return gathered_[block].block.weight[i] != 0; };
    PlaneStack<Real> stack(setup_.shape, components);
    for (const StackedFacet& f : setup_.facets) {
      const StackOrderOptions ordering = setup_.ordering(f);
      const StackOrder order = order_for_stack(blocks, wanted, ordering);
      for (const Slab& slab : slabs_of(order, setup_, f.facet.geometry.width, components)) {
        stack.reserve(slab.planes);
        stack.clear(setup_.options.threads);
        for (const std::vector<StackTask>& tasks : tasks_of(order, setup_.shape, slab, setup_.taps.w.width)) {
          for (const StackTask& task : tasks)
            std::fill_n(stack.row_used.begin() + task.tile_v * setup_.shape.tile, setup_.shape.tile + setup_.shape.width - 1,
                        1);
          parallel_for(tasks.size(), setup_.options.threads,
                       [&](std::size_t i) { grid_tile(ordering.scale, blocks, order, tasks[i], slab.first, stack); });
        }
        add_stack_to_images(stack, f, slab.first, setup_.options.threads, images);
      }
    }
    gathered_.clear();
    samples_ = 0;
  }

  void grid_tile(const StackScale& scale, const std::vector<const SampleCoordinates*>& blocks, const StackOrder& order,
                 const StackTask& task, int first_plane, PlaneStack<Real>& stack) const {
    const StackShape& s = setup_.shape;
    StackBuffer<Real> buffer(s.tile, setup_.taps.u.padded, task.planes.planes, stack.components);
    int in_buffer = 0;
    for_each_batch(setup_, scale, blocks, order, task, [&](StackBatch<Real>& batch, const BatchPhases& phases) {
      double psf_cosine[BatchPhases::capacity], psf_sine[BatchPhases::capacity];
      if (stack.components > 2) psf_phasors(phases, batch.count, psf_cosine, psf_sine);
      // The grid holds conj(V), whose backward transform is the image; see stack_order.h for the axes.
      for (int k = 0; k < batch.count; ++k) {
        const Gathered& g = gathered_[phases.block[k]];
        const double weight = g.block.weight[phases.sample[k]];
        const std::complex<double> v = g.visibility(phases.sample[k]);
        const double re = weight * v.real(), im = phases.mirrored[k] ? weight * v.imag() : -weight * v.imag();
        batch.value[0][k] = static_cast<Real>(re * phases.cosine[k] - im * phases.sine[k]);
        batch.value[1][k] = static_cast<Real>(re * phases.sine[k] + im * phases.cosine[k]);
        if (stack.components == 2) continue;
        batch.value[2][k] = static_cast<Real>(weight * psf_cosine[k]);
        batch.value[3][k] = static_cast<Real>(weight * psf_sine[k]);
      }
      spread(setup_.taps, batch, buffer);
      in_buffer += batch.count;
      if (in_buffer < most_in_buffer) return;
      flush_buffer(task, first_plane, buffer, stack);
      std::fill(buffer.cell.begin(), buffer.cell.end(), Real(0));
      in_buffer = 0;
    });
    flush_buffer(task, first_plane, buffer, stack);
  }

  void flush_buffer(const StackTask& task, int first_plane, const StackBuffer<Real>& buffer, PlaneStack<Real>& stack) const {
    const StackShape& s = setup_.shape;
    for_each_chunk(s, task, stack.components, [&](int row, int chunk, int plane, int component, int count) {
      const Real* from = buffer.row(plane, row, component) + chunk * s.tile;
      Real* to =
          stack.chunk(task.tile_v * s.tile + row, task.tile_u + chunk, task.planes.first - first_plane + plane, component);
      for (int c = 0; c < count; ++c) to[c] += from[c];
    });
  }

  /// The facet's phasors seen from the image's middle pixel, where the PSF's source is.
  void psf_phasors(const BatchPhases& phases, int count, double* cosine, double* sine) const {
    const ImageGeometry& g = setup_.options.geometry;
    if (!g.off_phase_centre()) {
      std::copy_n(phases.cosine, count, cosine);
      std::copy_n(phases.sine, count, sine);
      return;
    }
    const PhasePosition middle = phase_position(g.centre);
    double turns[BatchPhases::capacity];
    for (int k = 0; k < count; ++k) {
      const VisibilityBlock& block = gathered_[phases.block[k]].block;
      const std::size_t row = phases.sample[k] / block.channels(), channel = phases.sample[k] % block.channels();
      const double to_middle = turns_per_hz(&block.uvw_m[3 * row], middle) * block.frequency_hz[channel];
      turns[k] = phases.turns[k] - (phases.mirrored[k] ? -to_middle : to_middle);
    }
    phasors(turns, count, cosine, sine);
  }

  const Setup<Real>& setup_;
  std::vector<Gathered> gathered_;
  std::size_t samples_ = 0;
  AdjointResult result_;
};

template <typename Real>
class WidePrediction : public Prediction {
 public:
  WidePrediction(const Setup<Real>& setup, const Image& model) : setup_(setup), model_(model) {}

  std::vector<std::complex<double>> at(const SampleCoordinates& coordinates) const override {
    return degrid({&coordinates}, [](std::size_t, std::size_t) { return true; }).front();
  }
  std::vector<std::complex<double>> at_usable(const VisibilityBlock& block) const override {
    return at_usable_of({&block}).front();
  }
  std::vector<std::vector<std::complex<double>>> at_usable_of(
      const std::vector<const VisibilityBlock*>& blocks) const override {
    return degrid({blocks.begin(), blocks.end()}, [&](std::size_t b, std::size_t i) { return blocks[b]->weight[i] != 0; });
  }
  std::size_t samples_at_once() const override { return setup_.options.samples_at_once; }

 private:
  using Visibilities = std::vector<std::vector<std::complex<double>>>;  ///< [block][sample]

  /// What samples and their mirror images gather in different tiles, by different threads.
  struct Halves {
    Visibilities direct;
    Visibilities mirrored;
  };

  template <typename Wanted>
  Visibilities degrid(const std::vector<const SampleCoordinates*>& blocks, const Wanted& wanted) const {
    Halves halves;
    for (const SampleCoordinates* at : blocks) halves.direct.emplace_back(at->samples());
    halves.mirrored = halves.direct;
    PlaneStack<Real> stack(setup_.shape, 2);
    for (const StackedFacet& f : setup_.facets) {
      const StackOrderOptions ordering = setup_.ordering(f);
      const StackOrder order = order_for_stack(blocks, wanted, ordering);
      for (const Slab& slab : slabs_of(order, setup_, f.facet.geometry.width, 2)) {
        stack.reserve(slab.planes);
        image_to_stack(model_, f, slab.first, setup_.options.threads, stack);
        for (const std::vector<StackTask>& tasks : tasks_of(order, setup_.shape, slab, setup_.taps.w.width))
          parallel_for(tasks.size(), setup_.options.threads,
                       [&](std::size_t i) { degrid_tile(ordering.scale, blocks, order, tasks[i], slab.first, stack, halves); });
      }
    }
    for (std::size_t b = 0; b < blocks.size(); ++b)
      for (std::size_t i = 0; i < halves.direct[b].size(); ++i) halves.direct[b][i] += std::conj(halves.mirrored[b][i]);
    return std::move(halves.direct);
  }

  void degrid_tile(const StackScale& scale, const std::vector<const SampleCoordinates*>& blocks, const StackOrder& order,
                   const StackTask& task, int first_plane, const PlaneStack<Real>& stack, Halves& halves) const {
    const StackShape& s = setup_.shape;
    StackBuffer<Real> buffer(s.tile, setup_.taps.u.padded, task.planes.planes, 2);
    for_each_chunk(s, task, 2, [&](int row, int chunk, int plane, int component, int count) {
      std::copy_n(
          stack.chunk(task.tile_v * s.tile + row, task.tile_u + chunk, task.planes.first - first_plane + plane, component),
          count, buffer.row(plane, row, component) + chunk * s.tile);
    });
    for_each_batch(setup_, scale, blocks, order, task, [&](StackBatch<Real>& batch, const BatchPhases& phases) {
      interpolate(setup_.taps, buffer, batch);
      for (int k = 0; k < batch.count; ++k) {
        const double re = double{batch.value[0][k]}, im = double{batch.value[1][k]};
        Visibilities& visibility = phases.mirrored[k] ? halves.mirrored : halves.direct;
        visibility[phases.block[k]][phases.sample[k]] +=
            std::complex<double>(re * phases.cosine[k] + im * phases.sine[k], re * phases.sine[k] - im * phases.cosine[k]);
      }
    });
  }

  const Setup<Real>& setup_;
  Image model_;
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
  constexpr double sample_bytes = sizeof(std::complex<double>) + sizeof(float);  // of a residual, or a PSF
  constexpr double run_bytes = 2 * sizeof(StackRun) + 8;  // at worst a run each, twice while they are sorted
  const double gathered = std::min(samples, static_cast<double>(o.samples_at_once)) * (sample_bytes + run_bytes);
  const StackShape shape = shape_of(o);
  const bool single = o.precision == Precision::single_precision;
  const int width = largest_part(o.geometry.width, o.facets_l);
  const double plane = single ? bytes_a_plane<float>(shape, 2, width) : bytes_a_plane<double>(shape, 2, width);
  const double image = static_cast<double>(o.geometry.pixels()) * sizeof(double);
  const double one = std::min(planes * plane, std::max(plane, static_cast<double>(o.stack_bytes)));
  const double both = std::min(2 * planes * plane, std::max(2 * plane, static_cast<double>(o.stack_bytes)));
  const double real_bytes = single ? sizeof(float) : sizeof(double);
  const double column = 6.0 * largest_part(o.geometry.height, o.facets_m) * sizeof(double) + 2.0 * o.nv * real_bytes;
  return {gathered + one + image, both - one + image, o.threads * 16 * column};
}

std::unique_ptr<Transform> make_transform(const WideTransformOptions& options) {
  return options.has_w_axis() ? make_wide_transform(options) : make_plane_transform(options);
}

}  // namespace misfit::imager
