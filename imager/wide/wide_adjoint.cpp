#include "imager/wide/wide_adjoint.h"

#include <algorithm>

#include "imager/data/horizon.h"
#include "imager/data/phase.h"
#include "imager/numerics/parallel.h"
#include "imager/numerics/phasors.h"
#include "imager/numerics/spares.h"
#include "imager/numerics/stage_times.h"
#include "imager/numerics/sum_unit.h"
#include "imager/transform/sampling.h"
#include "imager/transform/span_sums.h"
#include "imager/wide/stack_rows.h"
#include "imager/wide/tile_sum.h"

namespace misfit::imager {
namespace {

template <typename Real>
class WideAdjoint : public AdjointSum {
 public:
  WideAdjoint(const WideSetup<Real>& setup, const AdjointOptions& options)
      : AdjointSum(options),
        setup_(setup),
        with_psf_(options.with_psf && !beyond_horizon(setup.options.geometry.centre)),
        value_unit_(images()) {
    const ImageGeometry& g = setup.options.geometry;
    for (std::size_t i = 0; i < images(); ++i) result_.images.emplace_back(g.width, g.height);
    result_.sums.resize(sets());
    if (options.with_psf) result_.psf = Image(g.width, g.height);
  }

  AdjointResult finish() override {
    flush();
    for (std::size_t i = 0; i < images(); ++i) {
      multiply(result_.images[i], value_unit_[i].unit());
      set_beyond_horizon(setup_.options.geometry, no_value, result_.images[i]);
    }
    multiply(result_.psf, weight_unit_.unit());
    if (with_psf_) {
      set_beyond_horizon(setup_.options.geometry, no_value, result_.psf);
    } else {
      std::fill(result_.psf.pixel.begin(), result_.psf.pixel.end(), no_value);
    }
    return std::move(result_);
  }

 protected:
  void add_sets(const VisibilityBlock& block, const VisibilitySets& sets) override {
    SampleSums counted;
    const WideTransformOptions& o = setup_.options;
    Gathered g{block, imaging_weights(block, {o.geometry, options_.beyond_grid, o.threads}, counted), {}};
    std::vector<SampleSums> sums;
    for (const VisibilitySet& set : sets) {
      sums.push_back(std::visit([&](const auto* visibility) { return sums_of(g.weight, visibility); }, set));
      sums.back() += counted;
    }
    for (std::size_t i = 0; i < sums.size(); ++i) result_.sums[i] += sums[i];
    make_room(sums);
    for (std::size_t i = 0; i < images(); ++i)
      g.weighted.push_back(std::visit(
          [&](const auto* visibility) { return weighted(g.weight, visibility, value_unit_[i].per_unit()); }, sets[i]));
    if (images() == 0 && !with_psf_) return;  // the PSF's middle lies beyond the horizon
    samples_ += block.samples();
    gathered_.push_back(std::move(g));
    if (samples_ >= setup_.options.samples_at_once) flush();
  }

 private:
  /// A block's samples, those left out with weight 0.
  struct Gathered {
    SampleCoordinates at;
    std::vector<float> weight;
    std::vector<std::vector<std::complex<Real>>> weighted;  ///< [image]: weight · V, in the values' unit
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

  template <typename Number>
  SampleSums sums_of(const std::vector<float>& weight, const std::complex<Number>* visibility) const {
    std::vector<SampleSums> part(pieces(weight.size()));
    for_pieces(weight.size(), [&](std::size_t p, std::size_t begin, std::size_t end) {
      add_span_to_sums(weight.data() + begin, visibility + begin, end - begin, part[p]);
    });
    SampleSums sums;
    for (const SampleSums& of_piece : part) sums += of_piece;
    return sums;
  }

  template <typename Number>
  std::vector<std::complex<Real>> weighted(const std::vector<float>& weight, const std::complex<Number>* visibility,
                                           double per_unit) const {
    std::vector<std::complex<Real>> values(weight.size());
    for_pieces(weight.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        if (weight[i] != 0) values[i] = std::complex<Real>(double{weight[i]} * per_unit * std::complex<double>(visibility[i]));
    });
    return values;
  }

  /// Brings the images to units that hold the coming samples, too. Samples gathered in other units are gridded first.
  void make_room(const std::vector<SampleSums>& coming) {
    std::vector<SumUnit<Real>> value_unit = value_unit_;
    SumUnit<Real> weight_unit = weight_unit_;
    std::vector<double> values;
    for (std::size_t i = 0; i < images(); ++i) values.push_back(value_unit[i].make_room(coming[i].weight_abs));
    const double weights = weight_unit.make_room(coming.front().weight);
    if (weights != 1 || std::any_of(values.begin(), values.end(), [](double by) { return by != 1; })) {
      flush();
      for (std::size_t i = 0; i < images(); ++i) multiply(result_.images[i], values[i]);
      multiply(result_.psf, weights);
    }
    value_unit_ = value_unit;
    weight_unit_ = weight_unit;
  }

  void flush() {
    if (gathered_.empty()) return;
    std::vector<WantedSamples> blocks;
    for (const Gathered& g : gathered_) blocks.push_back({&g.at, g.weight.data()});
    std::vector<Image*> of_grid;
    for (Image& image : result_.images) of_grid.push_back(&image);
    if (with_psf_) of_grid.push_back(&result_.psf);
    const int grids = static_cast<int>(of_grid.size()), threads = setup_.options.threads;
    PlaneStack<Real> stack(setup_.shape, grids);
    ImagePlanes<Real> planes(setup_.shape.nv, grids);
    Spares<StackBuffer<Real>> spares;
    for (const StackedFacet& f : setup_.facets) {
      const StackOrderOptions ordering = setup_.ordering(f);
      const StackOrder order = order_for_stack(blocks, ordering);
      for (const Slab& slab : slabs_of(order, most_pairs(setup_.options, grids))) {
        const int band_tiles = tiles_a_band(setup_.options, slab.pairs, grids);
        stack.reserve(2 * slab.pairs, band_tiles);
        planes.reserve(f.facet.geometry.width, 2 * slab.pairs);
        StackRows<Real> rows(stack, planes, threads);
        for (const Band& band : bands_of(setup_.shape, band_tiles)) {
          stack.advance(std::min(band.begin * setup_.shape.tile, rows.first_awaited()), threads);
          const auto colours = tasks_of(order, setup_.shape, slab, ordering.width_w, band);
          stack.use_tiles(tiles_of(colours), threads);
          for (const std::vector<StackTask>& tasks : colours)
            parallel_for(tasks.size(), threads, [&](std::size_t i) {
              auto buffer = spares.take([&] { return std::make_unique<StackBuffer<Real>>(buffer_of(setup_, grids)); });
              grid_tile({blocks, order, ordering}, tasks[i], slab, *buffer, stack);
              spares.give_back(std::move(buffer));
            });
          add_seconds_of(result_.fft_s, [&] { rows.to_image(band.end * setup_.shape.tile); });
        }
        add_seconds_of(result_.fft_s, [&] { planes_to_images(planes, f, slab.first, threads, of_grid); });
      }
    }
    gathered_.clear();
    samples_ = 0;
  }

  static std::vector<TilePlace> tiles_of(const std::vector<std::vector<StackTask>>& colours) {
    std::vector<TilePlace> tiles;
    for (const std::vector<StackTask>& tasks : colours)
      for (const StackTask& task : tasks) tiles.push_back({task.tile_u, task.tile_v});
    return tiles;
  }

  void grid_tile(const StackSamples& samples, const StackTask& task, const Slab& slab, StackBuffer<Real>& buffer,
                 PlaneStack<Real>& stack) const {
    TileSum<Real> sum(setup_, task, slab, is_sparse(samples.order, task), buffer, stack);
    const auto ahead = [&](std::uint32_t block, std::size_t first, std::size_t last) {
      const Gathered& g = gathered_[block];
      for (const std::size_t sample : {first, last}) {
        for (const auto& weighted : g.weighted) hwy::Prefetch(&weighted[sample]);
        if (with_psf_) hwy::Prefetch(&g.weight[sample]);
      }
    };
    const auto done = [&](StackBatch<Real>& batch, BatchPhases& phases) {
      for (std::size_t i = 0; i < images(); ++i) set_values(phases, i, batch.value[i]);
      if (with_psf_) set_psf_values(phases, batch);
      sum.add(batch);
      phases.most = sum.most_in_batch();
    };
    for_each_batch<Real>(samples, task, ahead, done, most_in_single_cell);  // the first batch shows whether samples crowd
    sum.finish();
  }

  /// The grid holds conj(V), whose backward transform is the image; see plane_stack.h for the axes. The V of a mirror image is
  /// the conjugate already.
  void set_values(const BatchPhases& phases, std::size_t image, std::complex<Real>* value) const {
    for (const BatchRun& run : phases.run) {
      const std::complex<Real>* weighted = &gathered_[run.block].weighted[image][run.sample];
      const double sign = run.mirrored ? 1 : -1;
      for (int k = run.begin; k < run.end; ++k, ++weighted) {
        const double re = double{weighted->real()}, im = sign * double{weighted->imag()};
        value[k] = {static_cast<Real>(re * phases.cosine[k] - im * phases.sine[k]),
                    static_cast<Real>(re * phases.sine[k] + im * phases.cosine[k])};
      }
    }
  }

  void weigh_psf(const BatchPhases& phases, const double* cosine, const double* sine, StackBatch<Real>& batch) const {
    const double per_unit = weight_unit_.per_unit();
    for (const BatchRun& run : phases.run)
      for (int k = run.begin; k < run.end; ++k) {
        const double weight = per_unit * gathered_[run.block].weight[run.sample + static_cast<std::size_t>(k - run.begin)];
        batch.value[images()][k] = {static_cast<Real>(weight * cosine[k]), static_cast<Real>(weight * sine[k])};
      }
  }

  /// Sets the values of a source of 1 Jy in the image's middle pixel, seen from the facet's.
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

  const WideSetup<Real>& setup_;
  bool with_psf_;  ///< whose source is above the horizon
  std::vector<Gathered> gathered_;
  std::size_t samples_ = 0;
  std::vector<SumUnit<Real>> value_unit_;  ///< [image]
  SumUnit<Real> weight_unit_;              ///< of the PSF
  AdjointResult result_;
};

}  // namespace

template <typename Real>
std::unique_ptr<AdjointSum> make_wide_adjoint(const WideSetup<Real>& setup, const AdjointOptions& options) {
  return std::make_unique<WideAdjoint<Real>>(setup, options);
}
template std::unique_ptr<AdjointSum> make_wide_adjoint<float>(const WideSetup<float>&, const AdjointOptions&);
template std::unique_ptr<AdjointSum> make_wide_adjoint<double>(const WideSetup<double>&, const AdjointOptions&);

}  // namespace misfit::imager
