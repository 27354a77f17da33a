#include "imager/coplanar/coplanar_adjoint.h"

#include <algorithm>

#include "imager/coplanar/crowded_tiles.h"
#include "imager/coplanar/share_loops.h"
#include "imager/coplanar/tile_walk.h"
#include "imager/data/horizon.h"
#include "imager/numerics/parallel.h"
#include "imager/numerics/stage_times.h"
#include "imager/numerics/sum_unit.h"

namespace misfit::imager {
namespace {

/// For most_in_tile_buffer, where the tile is crowded.
constexpr int most_in_crowded_buffer = 1024;

template <typename Real>
class CoplanarAdjoint : public AdjointSum {
 public:
  /// Makes `of_each` images for each set of visibilities: more than one where samples have shares in them.
  CoplanarAdjoint(const CoplanarSetup<Real>& setup, const AdjointOptions& options, std::size_t of_each = 1)
      : AdjointSum(options), setup_(setup), seen_(setup.geometry), of_each_(of_each), value_unit_(images()), sums_(sets()) {
    if (images() == 0) seen_.centre = {};
    grid_.resize(2 * images() * of_each_ + (options.with_psf ? 1 : 0));
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
    for (std::size_t i = 0; i < images(); ++i) result.images.push_back(image_of(i, 0));
    if (options_.with_psf) result.psf = to_image(std::move(grid_.back()), {}, weight_unit_.unit());
    result.fft_s = watch.seconds();
    return result;
  }

  /// Gives the samples of the next blocks these shares in a set's images; null: the set has one image.
  void set_shares(const SampleShares* shares) { shares_ = shares; }

  void flush_crowded() {
    const auto tiles_u = static_cast<std::size_t>(setup_.shape.tiles_u());
    for (std::size_t tile = 0; tile < crowded_.tiles(); ++tile)
      if (TileBuffer<double>* const sum = crowded_.of(tile); sum != nullptr)
        flush({static_cast<int>(tile % tiles_u), static_cast<int>(tile / tiles_u), tile}, *sum);
  }

  /// Makes one of the images of a set, which destroys its grid. All crowded tiles have to be flushed before.
  Image image_of(std::size_t set, std::size_t image) {
    const std::size_t plane = 2 * (set * of_each_ + image);
    return to_image(std::move(grid_[plane]), std::move(grid_[plane + 1]), value_unit_[set].unit());
  }

 protected:
  void add_sets(const VisibilityBlock& block, const VisibilitySets& sets) override {
    const Wanted wanted = options_.beyond_grid ? Wanted::imaging_beyond : Wanted::imaging;
    const TileOrder order = order_by_tile(block, sets, setup_.shape, setup_.geometry, wanted, setup_.threads);
    for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += order.sums[i];
    make_room(order.sums);
    crowded_.count(order.samples, most_in_place, TileBuffer<double>(setup_.shape.tile, setup_.taps_u.padded, plane_count()));
    for (const std::vector<TileTask>& tasks : coloured_tasks(order, setup_.shape))
      parallel_for(tasks.size(), setup_.threads, [&](std::size_t i) { grid_tile(block, sets, order, tasks[i]); });
  }

 private:
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
    for (std::size_t i = 0; i < images(); ++i)
      by.insert(by.end(), 2 * of_each_, value_unit_[i].make_room(coming[i].weight_abs));
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

  void grid_tile(const VisibilityBlock& block, const VisibilitySets& sets, const TileOrder& order, const TileTask& task) {
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
      if (in_place || in_buffer < (crowded == nullptr ? most_in_tile_buffer : most_in_crowded_buffer)) return;
      empty_buffer();
      std::fill(buffer.cell.begin(), buffer.cell.end(), Real(0));
      in_buffer = 0;
    };
    for_each_batch<Real>(seen_, setup_.shape, block, order, task, ahead, done);
    if (!in_place) empty_buffer();
  }

  /// The grid holds conj(V), whose backward transform is the image; see tile_order.h for the axes.
  void set_values(const VisibilityBlock& block, const VisibilitySets& sets, const BatchSamples& samples,
                  TileBatch<Real>& batch) const {
    double weight[BatchSamples::capacity];
    for (int k = 0; k < batch.count; ++k) weight[k] = block.weight[samples.index[k]];
    if (shares_ != nullptr) {
      set_shared_values(block, sets, samples, weight, batch);
      return;
    }
    for (std::size_t i = 0; i < images(); ++i) {
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
    for (int k = 0; k < batch.count; ++k) batch.value[2 * images()][k] = static_cast<Real>(weight[k] * per_unit);
  }

  /// c̄_k w V in place of w V.
  void set_shared_values(const VisibilityBlock& block, const VisibilitySets& sets, const BatchSamples& samples,
                         const double* weight, TileBatch<Real>& batch) const {
    const SharePlaces<Real> places(*shares_, block, samples.index, samples.conjugate, batch.count);
    for (std::size_t i = 0; i < images(); ++i) {
      const double per_unit = value_unit_[i].per_unit();
      SharedValues<Real> values;
      std::visit(
          [&](const auto* visibility) {
            for (int k = 0; k < batch.count; ++k) {
              const double scaled = weight[k] * per_unit;
              const std::complex<double> value = samples.from_middle(std::complex<double>(visibility[samples.index[k]]), k);
              values.real[k] = static_cast<Real>(scaled * value.real());
              values.imaginary[k] = static_cast<Real>(scaled * value.imag());
            }
          },
          sets[i]);
      share_out(places, values, batch.value + 2 * i * of_each_);
    }
  }

  static void add_up(const TileBuffer<Real>& buffer, TileBuffer<double>& to) {
    for (std::size_t i = 0; i < buffer.cell.size(); ++i) to.cell[i] += double{buffer.cell[i]};
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

  const CoplanarSetup<Real>& setup_;
  ImageGeometry seen_;  ///< from its middle pixel a PSF needs no phases
  std::size_t of_each_;
  const SampleShares* shares_ = nullptr;
  std::vector<std::vector<Real>> grid_;  ///< [plane]: real and imaginary parts of each image; last, for a PSF, weights
  std::vector<Real*> planes_;
  CrowdedTiles<Real> crowded_;
  std::vector<SumUnit<Real>> value_unit_;  ///< [image], of real and imaginary parts
  SumUnit<Real> weight_unit_;              ///< of the weights
  std::vector<SampleSums> sums_;           ///< [set]
};

template <typename Real>
class CoplanarSharedAdjoint : public SharedAdjoint {
 public:
  CoplanarSharedAdjoint(const CoplanarSetup<Real>& setup, std::size_t sets, std::size_t images)
      : sets_(sets), images_(images), sum_(setup, {.images = static_cast<int>(sets), .beyond_grid = true}, images) {}

  void add(const VisibilityBlock& block, const VisibilitySets& sets, const SampleShares& shares) override {
    sum_.set_shares(&shares);
    static_cast<AdjointSum&>(sum_).add(block, sets);
    sum_.set_shares(nullptr);
  }
  void finish(const std::function<void(std::size_t, std::size_t, const Image&)>& take) override {
    sum_.flush_crowded();
    for (std::size_t set = 0; set < sets_; ++set)
      for (std::size_t image = 0; image < images_; ++image) {
        const Stopwatch watch;
        const Image made = sum_.image_of(set, image);
        fft_s_ += watch.seconds();
        take(set, image, made);
      }
  }
  double fft_s() const override { return fft_s_; }

 private:
  std::size_t sets_;
  std::size_t images_;
  CoplanarAdjoint<Real> sum_;
  double fft_s_ = 0;
};

}  // namespace

template <typename Real>
std::unique_ptr<SharedAdjoint> make_shared_adjoint(const CoplanarSetup<Real>& setup, std::size_t sets, std::size_t images) {
  return std::make_unique<CoplanarSharedAdjoint<Real>>(setup, sets, images);
}
template std::unique_ptr<SharedAdjoint> make_shared_adjoint<float>(const CoplanarSetup<float>&, std::size_t, std::size_t);
template std::unique_ptr<SharedAdjoint> make_shared_adjoint<double>(const CoplanarSetup<double>&, std::size_t, std::size_t);

template <typename Real>
std::unique_ptr<AdjointSum> make_coplanar_adjoint(const CoplanarSetup<Real>& setup, const AdjointOptions& options) {
  return std::make_unique<CoplanarAdjoint<Real>>(setup, options);
}
template std::unique_ptr<AdjointSum> make_coplanar_adjoint<float>(const CoplanarSetup<float>&, const AdjointOptions&);
template std::unique_ptr<AdjointSum> make_coplanar_adjoint<double>(const CoplanarSetup<double>&, const AdjointOptions&);

}  // namespace misfit::imager
