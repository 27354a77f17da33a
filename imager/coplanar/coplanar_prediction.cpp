#include "imager/coplanar/coplanar_prediction.h"

#include <algorithm>

#include "imager/coplanar/share_loops.h"
#include "imager/coplanar/tile_walk.h"
#include "imager/data/horizon.h"
#include "imager/numerics/parallel.h"
#include "imager/numerics/stage_times.h"

namespace misfit::imager {
namespace {

/// Images on their grids, from which samples come.
template <typename Real>
class GriddedImages {
 public:
  explicit GriddedImages(const CoplanarSetup<Real>& setup) : setup_(setup) {}

  void add(const Image& image) {
    const Stopwatch watch;
    HalfGrid<Real>& grid = grids_.emplace_back(setup_.shape);
    if (!crosses_horizon(setup_.geometry)) {
      image_to_grid(image, setup_.correction, setup_.threads, grid);
    } else {
      Image seen = image;
      set_beyond_horizon(setup_.geometry, 0, seen);
      image_to_grid(seen, setup_.correction, setup_.threads, grid);
    }
    planes_.insert(planes_.end(), {grid.real.data(), grid.imaginary.data()});
    fft_s_ += watch.seconds();
  }

  double fft_s() const { return fft_s_; }

  /// V of the one image, or, with shares, of all images.
  std::vector<std::complex<double>> degrid(const VisibilityBlock& block, Wanted wanted, const SampleShares* shares) const {
    const TileOrder order = order_by_tile(block, {}, setup_.shape, setup_.geometry, wanted, setup_.threads);
    std::vector<std::complex<double>> visibility(block.samples());
    std::vector<TileTask> tasks;
    for (const std::vector<TileTask>& colour : coloured_tasks(order, setup_.shape))
      tasks.insert(tasks.end(), colour.begin(), colour.end());
    parallel_for(tasks.size(), setup_.threads, [&](std::size_t i) {
      const bool in_place = sparse(order, tasks[i]);
      TileBuffer<Real> buffer(setup_.shape.tile, setup_.taps_u.padded, in_place ? 0 : static_cast<int>(planes_.size()));
      if (!in_place) load(tasks[i], buffer);
      const TileCells<const Real> cells =
          in_place ? cells_of(setup_.shape, tasks[i], planes_) : TileCells<const Real>(buffer.cells());
      if (i + 1 < tasks.size() && !sparse(order, tasks[i + 1]))
        for (const Real* plane : planes_) prefetch_tile(setup_.shape, tasks[i + 1], plane);
      const auto ahead = [&](std::size_t sample) { hwy::Prefetch(&visibility[sample]); };
      const auto done = [&](TileBatch<Real>& batch, const BatchSamples& samples) {
        interpolate(setup_.taps_u, setup_.taps_v, cells, batch);
        SharedValues<Real> values;
        if (shares != nullptr)
          bring_together({*shares, block, samples.index, samples.conjugate, batch.count}, batch.value, values);
        for (int k = 0; k < batch.count; ++k) {
          const double imaginary = double{batch.value[1][k]};
          const std::complex<double> value =
              shares != nullptr ? std::complex<double>(values.real[k], values.imaginary[k])
                                : std::complex<double>(batch.value[0][k], samples.conjugate[k] ? imaginary : -imaginary);
          visibility[samples.index[k]] = samples.from_phase_centre(value, k);
        }
      };
      for_each_batch<Real>(setup_.geometry, setup_.shape, block, order, tasks[i], ahead, done);
    });
    return visibility;
  }

 private:
  void load(const TileTask& task, TileBuffer<Real>& buffer) const {
    const int reach = setup_.shape.tile + setup_.shape.width - 1;
    for (int r = 0; r < reach; ++r) {
      const std::size_t start = first_cell(setup_.shape, task, r);
      for (int plane = 0; plane < buffer.planes; ++plane)
        std::copy_n(planes_[static_cast<std::size_t>(plane)] + start, reach, buffer.row(r, plane));
    }
  }

  const CoplanarSetup<Real>& setup_;
  std::vector<HalfGrid<Real>> grids_;
  std::vector<const Real*> planes_;  ///< real and imaginary parts of each image
  double fft_s_ = 0;
};

template <typename Real>
class CoplanarPrediction : public Prediction {
 public:
  CoplanarPrediction(const CoplanarSetup<Real>& setup, const Image& model) : gridded_(setup) { gridded_.add(model); }

  std::vector<std::complex<double>> at(const SampleCoordinates& coordinates) const override {
    VisibilityBlock block;
    static_cast<SampleCoordinates&>(block) = coordinates;
    return gridded_.degrid(block, Wanted::all, nullptr);
  }
  std::vector<std::complex<double>> at_usable(const VisibilityBlock& block) const override {
    return gridded_.degrid(block, Wanted::usable, nullptr);
  }
  double fft_s() const override { return gridded_.fft_s(); }

 private:
  GriddedImages<Real> gridded_;
};

template <typename Real>
class CoplanarSharedPrediction : public SharedPrediction {
 public:
  CoplanarSharedPrediction(const CoplanarSetup<Real>& setup, const std::vector<Image>& images) : gridded_(setup) {
    for (const Image& image : images) gridded_.add(image);
  }

  std::vector<std::complex<double>> at_usable(const VisibilityBlock& block, const SampleShares& shares) const override {
    return gridded_.degrid(block, Wanted::usable, &shares);
  }
  double fft_s() const override { return gridded_.fft_s(); }

 private:
  GriddedImages<Real> gridded_;
};

}  // namespace

template <typename Real>
std::unique_ptr<Prediction> make_coplanar_prediction(const CoplanarSetup<Real>& setup, const Image& model) {
  return std::make_unique<CoplanarPrediction<Real>>(setup, model);
}
template std::unique_ptr<Prediction> make_coplanar_prediction<float>(const CoplanarSetup<float>&, const Image&);
template std::unique_ptr<Prediction> make_coplanar_prediction<double>(const CoplanarSetup<double>&, const Image&);

template <typename Real>
std::unique_ptr<SharedPrediction> make_shared_prediction(const CoplanarSetup<Real>& setup, const std::vector<Image>& images) {
  return std::make_unique<CoplanarSharedPrediction<Real>>(setup, images);
}
template std::unique_ptr<SharedPrediction> make_shared_prediction<float>(const CoplanarSetup<float>&,
                                                                         const std::vector<Image>&);
template std::unique_ptr<SharedPrediction> make_shared_prediction<double>(const CoplanarSetup<double>&,
                                                                          const std::vector<Image>&);

}  // namespace misfit::imager
