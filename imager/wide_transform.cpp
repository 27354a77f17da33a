#include "imager/wide_transform.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "imager/parallel.h"
#include "imager/phasors.h"
#include "imager/sampling.h"
#include "imager/smooth_correction.h"
#include "imager/stack_loops.h"
#include "imager/stack_order.h"
#include "imager/tile_order.h"

namespace misfit::imager {
namespace {

/// One facet, ready for both directions.
struct FacetSetup {
  Facet facet;
  double plane_step = 0;    ///< wavelengths
  std::vector<double> h_u;  ///< [column]
  std::vector<double> h_v;  ///< [row]
};

template <typename Real>
struct Setup {
  WideTransformOptions options;
  StackShape shape;
  StackTaps<Real> taps;
  SmoothCorrection h_w;
  std::vector<FacetSetup> facets;

  StackOrderOptions ordering(const FacetSetup& f) const {
    return {shape, taps.w.width, StackScale(shape, f.facet, f.plane_step), options.threads};
  }
};

std::vector<double> axis_correction(const kernels::Kernel& kernel, int pixels, int fft_size) {
  const Eigen::VectorXd x = (Eigen::VectorXd::LinSpaced(pixels, 0, pixels - 1).array() - pixels / 2) / fft_size;
  const Eigen::VectorXd h = kernels::optimal_correction(kernel.polynomial, x);
  return {h.begin(), h.end()};
}

template <typename Real>
Setup<Real> set_up(const WideTransformOptions& o) {
  constexpr int tile = 16;
  Setup<Real> s{
      o,
      {o.nu, o.nv, o.kernel_u.width(), std::max(tile, o.kernel_u.width())},
      {TapTable<Real>(o.kernel_u.polynomial), TapTable<Real>(o.kernel_v.polynomial), TapTable<Real>(o.kernel_w.polynomial)},
      SmoothCorrection(o.kernel_w),
      {}};
  for (const Facet& facet : split_into_facets(o.geometry, o.facets_l, o.facets_m)) {
    constexpr double flat = 1e-15;  // a facet of one pixel has no curvature
    s.facets.push_back({facet, o.kernel_w.x0 / std::max(facet.reach, flat),
                        axis_correction(o.kernel_u, facet.geometry.width, o.nu),
                        axis_correction(o.kernel_v, facet.geometry.height, o.nv)});
  }
  return s;
}

/// h_u h_v h_w at every pixel of a facet: visit(row, column in the whole image, h), with NaN beyond the horizon.
template <typename Real, typename Visit>
void for_corrected_pixels(const Setup<Real>& setup, const FacetSetup& f, const Visit& visit) {
  const ImageGeometry& g = f.facet.geometry;
  parallel_for(static_cast<std::size_t>(g.height), setup.options.threads, [&](std::size_t r) {
    const int row = static_cast<int>(r);
    for (int column = 0; column < g.width; ++column) {
      const double x = f.plane_step * f.facet.curvature(column, row);
      const double h = setup.h_w(x) * f.h_u[static_cast<std::size_t>(column)] * f.h_v[r];
      visit(f.facet.first_row + row, f.facet.first_column + column, h);
    }
  });
}

/// Neighbouring planes that are held at a time.
struct Slab {
  int first = 0;
  int planes = 0;
};

/// The planes that hold anything, as many at a time as memory allows.
template <typename Real>
std::vector<Slab> slabs_of(const StackOrder& order, const Setup<Real>& setup, int width, int components) {
  const StackShape& s = setup.shape;
  const double plane_bytes = sizeof(Real) * static_cast<double>(components) *
                             (static_cast<double>(s.cells()) + static_cast<double>(s.nv) * static_cast<double>(width));
  const int most = std::max(1, static_cast<int>(static_cast<double>(setup.options.stack_bytes) / plane_bytes));
  std::vector<Slab> slabs;
  for (std::size_t k = 0; k < order.plane_used.size(); ++k) {
    if (order.plane_used[k] == 0) continue;
    const int plane = order.first_plane + static_cast<int>(k);
    if (slabs.empty() || slabs.back().planes == most || slabs.back().first + slabs.back().planes != plane)
      slabs.push_back({plane, 0});
    ++slabs.back().planes;
  }
  return slabs;
}

/// A tile's runs that reach into a slab.
struct StackTask {
  int tile_u;
  int tile_v;
  std::size_t begin;
  std::size_t end;
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
      colours[static_cast<std::size_t>(v % 2 * 2 + u % 2)].push_back(
          {u, v, static_cast<std::size_t>(begin - order.run.begin()), static_cast<std::size_t>(end - order.run.begin())});
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
  bool folded[capacity];
  double turns[capacity];
  double cosine[capacity];
  double sine[capacity];
};

/// Walks through a task's samples in batches: done(batch, phases) for each, phases computed.
template <typename Real, typename Done>
void for_each_batch(const Setup<Real>& setup, const StackScale& scale, const std::vector<const SampleCoordinates*>& blocks,
                    const StackOrder& order, const StackTask& task, const Slab& slab, const Done& done) {
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
    const StackRow row(&at.uvw_m[std::size_t{3} * run.row], scale);
    for (std::size_t channel = run.first; channel < std::size_t{run.first} + run.count; ++channel) {
      const double frequency = at.frequency_hz[channel];
      const TapPosition u(reduced(row.u_per_hz * frequency, s.nu), s.width);
      const TapPosition v(reduced(row.v_per_hz * frequency, s.nv), s.width);
      const TapPosition w(row.w_per_hz * frequency, setup.taps.w.width);
      const int k = batch.count++;
      batch.plane[k] = w.first - slab.first;
      batch.column[k] = u.first + s.margin() - task.tile_u * s.tile;
      batch.row[k] = v.first + s.margin() - task.tile_v * s.tile;
      batch.tu[k] = static_cast<Real>(u.t);
      batch.tv[k] = static_cast<Real>(v.t);
      batch.tw[k] = static_cast<Real>(w.t);
      phases.block[k] = run.block;
      phases.sample[k] = run.row * at.channels() + channel;
      phases.folded[k] = row.folded;
      phases.turns[k] = row.turns_per_hz * frequency;
      if (batch.count == StackBatch<Real>::capacity) finish();
    }
  }
  if (batch.count > 0) finish();
}

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
    for (const FacetSetup& f : setup_.facets)
      for_corrected_pixels(setup_, f, [&](int row, int column, double h) {
        result_.image.at(row, column) *= h;
        if (!result_.psf.pixel.empty()) result_.psf.at(row, column) *= h;
      });
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
    for (const FacetSetup& f : setup_.facets) {
      if (f.facet.empty) continue;
      const StackOrderOptions ordering = setup_.ordering(f);
      const StackOrder order = order_for_stack(blocks, wanted, ordering);
      for (const Slab& slab : slabs_of(order, setup_, f.facet.geometry.width, components)) {
        PlaneStack<Real> stack(setup_.shape, slab.planes, components);
        for (const std::vector<StackTask>& tasks : tasks_of(order, setup_.shape, slab, setup_.taps.w.width))
          parallel_for(tasks.size(), setup_.options.threads,
                       [&](std::size_t i) { grid_tile(ordering.scale, blocks, order, tasks[i], slab, stack); });
        add_stack_to_images(stack, f.facet, {slab.first, f.plane_step}, setup_.options.threads, images);
      }
    }
    gathered_.clear();
    samples_ = 0;
  }

  void grid_tile(const StackScale& scale, const std::vector<const SampleCoordinates*>& blocks, const StackOrder& order,
                 const StackTask& task, const Slab& slab, PlaneStack<Real>& stack) const {
    const StackShape& s = setup_.shape;
    StackBuffer<Real> buffer(s.tile, setup_.taps.u.padded, slab.planes, stack.components);
    for_each_batch(setup_, scale, blocks, order, task, slab, [&](StackBatch<Real>& batch, const BatchPhases& phases) {
      // The grid holds conj(V), whose backward transform is the image; see stack_order.h for the axes.
      for (int k = 0; k < batch.count; ++k) {
        const Gathered& g = gathered_[phases.block[k]];
        const double weight = g.block.weight[phases.sample[k]];
        const std::complex<double> v = g.visibility(phases.sample[k]);
        const double re = weight * v.real(), im = phases.folded[k] ? weight * v.imag() : -weight * v.imag();
        batch.value[0][k] = static_cast<Real>(re * phases.cosine[k] - im * phases.sine[k]);
        batch.value[1][k] = static_cast<Real>(re * phases.sine[k] + im * phases.cosine[k]);
        batch.value[2][k] = static_cast<Real>(weight * phases.cosine[k]);
        batch.value[3][k] = static_cast<Real>(weight * phases.sine[k]);
      }
      spread(setup_.taps, batch, buffer);
    });
    const int reach = s.tile + s.width - 1;
    for (int r = 0; r < reach; ++r) {
      for (int plane = 0; plane < slab.planes; ++plane)
        for (int component = 0; component < stack.components; ++component) {
          const Real* from = buffer.row(plane, r, component);
          Real* to = stack.row(plane, component, task.tile_v * s.tile + r) + task.tile_u * s.tile;
          for (int c = 0; c < reach; ++c) to[c] += from[c];
        }
      stack.row_used[static_cast<std::size_t>(task.tile_v * s.tile + r)] = 1;
    }
  }

  const Setup<Real>& setup_;
  std::vector<Gathered> gathered_;
  std::size_t samples_ = 0;
  AdjointResult result_;
};

template <typename Real>
class WidePrediction : public Prediction {
 public:
  WidePrediction(const Setup<Real>& setup, const Image& model) : setup_(setup), corrected_(model) {
    for (const FacetSetup& f : setup.facets)
      for_corrected_pixels(setup, f, [&](int row, int column, double h) {
        corrected_.at(row, column) = std::isnan(h) ? 0 : corrected_.at(row, column) * h;
      });
  }

  std::vector<std::complex<double>> at(const SampleCoordinates& coordinates) const override {
    return degrid(coordinates, [](std::size_t, std::size_t) { return true; });
  }
  std::vector<std::complex<double>> at_usable(const VisibilityBlock& block) const override {
    return degrid(block, [&](std::size_t, std::size_t i) { return block.weight[i] != 0; });
  }

 private:
  template <typename Wanted>
  std::vector<std::complex<double>> degrid(const SampleCoordinates& at, const Wanted& wanted) const {
    std::vector<std::complex<double>> visibility(at.samples());
    const std::vector<const SampleCoordinates*> blocks{&at};
    for (const FacetSetup& f : setup_.facets) {
      if (f.facet.empty) continue;
      const StackOrderOptions ordering = setup_.ordering(f);
      const StackOrder order = order_for_stack(blocks, wanted, ordering);
      for (const Slab& slab : slabs_of(order, setup_, f.facet.geometry.width, 2)) {
        PlaneStack<Real> stack(setup_.shape, slab.planes, 2);
        image_to_stack(corrected_, f.facet, {slab.first, f.plane_step}, setup_.options.threads, stack);
        for (const std::vector<StackTask>& tasks : tasks_of(order, setup_.shape, slab, setup_.taps.w.width))
          parallel_for(tasks.size(), setup_.options.threads,
                       [&](std::size_t i) { degrid_tile(ordering.scale, blocks, order, tasks[i], slab, stack, visibility); });
      }
    }
    return visibility;
  }

  void degrid_tile(const StackScale& scale, const std::vector<const SampleCoordinates*>& blocks, const StackOrder& order,
                   const StackTask& task, const Slab& slab, const PlaneStack<Real>& stack,
                   std::vector<std::complex<double>>& visibility) const {
    const StackShape& s = setup_.shape;
    StackBuffer<Real> buffer(s.tile, setup_.taps.u.padded, slab.planes, 2);
    const int reach = s.tile + s.width - 1;
    for (int plane = 0; plane < slab.planes; ++plane)
      for (int r = 0; r < reach; ++r)
        for (int component = 0; component < 2; ++component)
          std::copy_n(stack.row(plane, component, task.tile_v * s.tile + r) + task.tile_u * s.tile, reach,
                      buffer.row(plane, r, component));
    for_each_batch(setup_, scale, blocks, order, task, slab, [&](StackBatch<Real>& batch, const BatchPhases& phases) {
      interpolate(setup_.taps, buffer, batch);
      for (int k = 0; k < batch.count; ++k) {
        const double re = double{batch.value[0][k]}, im = double{batch.value[1][k]};
        const std::complex<double> conjugate(re * phases.cosine[k] + im * phases.sine[k],
                                             im * phases.cosine[k] - re * phases.sine[k]);
        visibility[phases.sample[k]] += phases.folded[k] ? conjugate : std::conj(conjugate);
      }
    });
  }

  const Setup<Real>& setup_;
  Image corrected_;
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

}  // namespace misfit::imager
