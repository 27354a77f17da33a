#include "imager/wide/wide_prediction.h"

#include <algorithm>
#include <utility>

#include "imager/numerics/parallel.h"
#include "imager/numerics/spares.h"
#include "imager/numerics/stage_times.h"
#include "imager/wide/stack_rows.h"

namespace misfit::imager {
namespace {

template <typename Real>
class WidePrediction : public Prediction {
 public:
  WidePrediction(const WideSetup<Real>& setup, Image model) : setup_(setup), model_(std::move(model)) {}

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

  Visibilities degrid(const std::vector<WantedSamples>& blocks) const {
    Visibilities visibilities;
    for (const WantedSamples& block : blocks) visibilities.emplace_back(block.at->samples());
    const int threads = setup_.options.threads;
    PlaneStack<Real> stack(setup_.shape, 1);
    ImagePlanes<Real> planes(setup_.shape.nv, 1);
    Spares<StackBuffer<Real>> spares;
    for (const StackedFacet& f : setup_.facets) {
      const StackOrderOptions ordering = setup_.ordering(f);
      const StackOrder order = order_for_stack(blocks, ordering);
      for (const Slab& slab : slabs_of(order, most_pairs(setup_.options, 1))) {
        const int band_tiles = tiles_a_band(setup_.options, slab.pairs, 1);
        stack.reserve(2 * slab.pairs, band_tiles);
        planes.reserve(f.facet.geometry.width, 2 * slab.pairs);
        add_seconds_of(fft_s_, [&] { image_to_planes(model_, f, slab.first, threads, planes); });
        StackRows<Real> rows(stack, planes, threads);
        for (const Band& band : bands_of(setup_.shape, band_tiles)) {
          stack.advance(band.begin * setup_.shape.tile, threads);
          add_seconds_of(fft_s_, [&] { rows.to_grid(band.end * setup_.shape.tile + setup_.shape.width); });
          for (const std::vector<StackTask>& tasks : tasks_of(order, setup_.shape, slab, ordering.width_w, band))
            parallel_for(tasks.size(), threads, [&](std::size_t i) {
              auto buffer = spares.take([&] { return std::make_unique<StackBuffer<Real>>(buffer_of(setup_, 1)); });
              degrid_tile({blocks, order, ordering}, tasks[i], slab, stack, *buffer, visibilities);
              spares.give_back(std::move(buffer));
            });
        }
      }
    }
    return visibilities;
  }

  void degrid_tile(const StackSamples& samples, const StackTask& task, const Slab& slab, const PlaneStack<Real>& stack,
                   StackBuffer<Real>& buffer, Visibilities& visibilities) const {
    const StackShape& s = setup_.shape;
    const int lowest = slab.place(task.planes.first);
    StackCells<const std::complex<Real>> cells = stack.cells_of(task.tile_u, task.tile_v, lowest, task.planes.planes);
    if (!is_sparse(samples.order, task)) {
      buffer.reserve(task.planes.planes);
      for_each_chunk(s, {0, s.reach()}, {0, task.planes.planes}, 1, [&](int row, int chunk, int plane, int grid, int count) {
        std::copy_n(stack.chunk(task.tile_v * s.tile + row, task.tile_u + chunk, lowest + plane, grid), count,
                    buffer.row(plane, row, grid) + chunk * s.tile);
      });
      cells = buffer.cells();
    }
    const auto ahead = [&](std::uint32_t block, std::size_t first, std::size_t last) {
      for (const std::size_t sample : {first, last}) hwy::Prefetch(&visibilities[block][sample]);
    };
    for_each_batch<Real>(samples, task, ahead, [&](StackBatch<Real>& batch, const BatchPhases& phases) {
      interpolate(setup_.taps, cells, batch);
      for (const BatchRun& run : phases.run) {
        std::complex<double>* visibility = &visibilities[run.block][run.sample];
        const double sign = run.mirrored ? -1 : 1;
        for (int k = run.begin; k < run.end; ++k, ++visibility) {
          const double re = double{batch.value[0][k].real()}, im = double{batch.value[0][k].imag()};
          *visibility += std::complex<double>(re * phases.cosine[k] + im * phases.sine[k],
                                              sign * (re * phases.sine[k] - im * phases.cosine[k]));
        }
      }
    });
  }

  const WideSetup<Real>& setup_;
  Image model_;
  mutable double fft_s_ = 0;
};

}  // namespace

template <typename Real>
std::unique_ptr<Prediction> make_wide_prediction(const WideSetup<Real>& setup, Image model) {
  return std::make_unique<WidePrediction<Real>>(setup, std::move(model));
}
template std::unique_ptr<Prediction> make_wide_prediction<float>(const WideSetup<float>&, Image);
template std::unique_ptr<Prediction> make_wide_prediction<double>(const WideSetup<double>&, Image);

}  // namespace misfit::imager
