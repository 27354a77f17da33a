#include "imager/coplanar/coplanar_prediction.h"

#include <algorithm>

#include "imager/coplanar/tile_walk.h"
#include "imager/data/horizon.h"
#include "imager/numerics/parallel.h"
#include "imager/numerics/stage_times.h"

namespace misfit::imager {
namespace {

template <typename Real>
class CoplanarPrediction : public Prediction {
 public:
  CoplanarPrediction(const CoplanarSetup<Real>& setup, const Image& model) : setup_(setup), grid_(setup.shape) {
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
    const TileOrder order = order_by_tile(block, {}, setup_.shape, setup_.geometry, wanted, setup_.threads);
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

  const CoplanarSetup<Real>& setup_;
  HalfGrid<Real> grid_;
  double fft_s_ = 0;
};

}  // namespace

template <typename Real>
std::unique_ptr<Prediction> make_coplanar_prediction(const CoplanarSetup<Real>& setup, const Image& model) {
  return std::make_unique<CoplanarPrediction<Real>>(setup, model);
}
template std::unique_ptr<Prediction> make_coplanar_prediction<float>(const CoplanarSetup<float>&, const Image&);
template std::unique_ptr<Prediction> make_coplanar_prediction<double>(const CoplanarSetup<double>&, const Image&);

}  // namespace misfit::imager
