#include "imager/weighting/imaging_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

/// The least weight of a usable sample.
constexpr float least = std::numeric_limits<float>::min();

bool has_f2(Weighting weighting) {
  return weighting == Weighting::briggs || weighting == Weighting::briggs_bandwidth_taper;
}

template <template <typename> class Cells>
Cells<float> factors_before_filter(const Cells<double>& density, const WeightingOptions& options, double f2) {
  if (options.weighting == Weighting::briggs_abs) return briggs_abs_factors(density, options.robust, options.noise_jy);
  if (has_f2(options.weighting)) return briggs_factors(density, f2);
  return uniform_factors(density, options.weighting == Weighting::superuniform ? options.box_reach : 0);
}

/// The factors of the cells of one density, with their f² and number.
template <template <typename> class Cells>
struct Factors {
  Factors(const Cells<double>& density, const WeightingOptions& options)
      : f2(has_f2(options.weighting) ? briggs_f2(density, options.robust) : 0),
        of_cells(factors_before_filter(density, options, f2)) {
    if (options.rank_filter) of_cells = rank_filtered(of_cells, *options.rank_filter);
    of_cells.for_each([this](float factor) { filled += factor > 0 ? 1 : 0; });
  }

  double f2;
  Cells<float> of_cells;
  std::uint64_t filled = 0;
};

/// 1/(1 + W f²/m) at r, where 1/(1 + W f²) is `briggs`.
double bandwidth_tapered(double briggs, double r) {
  const double m = r >= 1 ? r + 0.5 : (4 - r) / (4 - 2 * r);
  return m * briggs / (1 + (m - 1) * briggs);
}

/// The factors of taper and window for a row's channels, [channel].
class RowTaper {
 public:
  RowTaper(const std::optional<UvTaper>& taper, const UvWindow& window, const std::vector<double>& frequency_hz)
      : taper_(taper), window_(window), windowed_(!window.is_whole_plane()) {
    for (const double frequency : frequency_hz) per_m_.push_back(frequency / speed_of_light_m_s);
  }
  void set_row(const double* uvw_m) {
    if (taper_) exponent_m2_ = taper_exponent_m2(*taper_, uvw_m[0], uvw_m[1]);
    if (windowed_) r_m_ = std::hypot(uvw_m[0], uvw_m[1]);
  }
  double at(std::size_t channel) const {
    const double per_m = per_m_[channel];
    const double gaussian = taper_ ? std::exp(-exponent_m2_ * (per_m * per_m)) : 1;
    return windowed_ ? gaussian * window_.factor(r_m_ * per_m) : gaussian;
  }

 private:
  const std::optional<UvTaper>& taper_;
  const UvWindow& window_;
  const bool windowed_;
  std::vector<double> per_m_;  ///< wavelengths
  double exponent_m2_ = 0;     ///< −ln of the taper's factor
  double r_m_ = 0;
};

/// The block itself if nobody else holds it, else a copy. Its holder before handed it over under a lock.
std::shared_ptr<VisibilityBlock> own(std::shared_ptr<const VisibilityBlock> block) {
  if (block.use_count() > 1) return std::make_shared<VisibilityBlock>(*block);
  return std::const_pointer_cast<VisibilityBlock>(std::move(block));  // made to be filled, so no constant
}

}  // namespace

WeightSums& WeightSums::operator+=(const WeightSums& other) {
  natural += other.natural;
  image += other.image;
  square_over_natural += other.square_over_natural;
  return *this;
}

WeightTotals& WeightTotals::operator+=(const WeightTotals& other) {
  sums += other.sums;
  w_spread += other.w_spread;
  return *this;
}

void WeightTotals::add_up(const Ranks& ranks) {
  sum_over(ranks, sums.natural, sums.image, sums.square_over_natural, w_spread.weight, w_spread.weighted_w_square);
}

bool WeightSums::outweigh_least(std::uint64_t samples) const {
  return image >= 1e6 * double{least} * static_cast<double>(samples);
}

double WeightSums::noise_jy() const {
  return std::sqrt(square_over_natural) / (2 * image);
}

double WeightSums::natural_noise_jy() const {
  return 1 / (2 * std::sqrt(natural));
}

ImagingWeights::ImagingWeights(const ImageGeometry& geometry, const WeightingOptions& options)
    : cells_(geometry), taper_(options.taper), window_(options.window) {}

ImagingWeights::ImagingWeights(const UvDensity& density, const WeightingOptions& options)
    : cells_(density.cells()),
      taper_(options.taper),
      window_(options.window),
      fractional_bandwidth_(options.weighting == Weighting::briggs_bandwidth_taper ? options.fractional_bandwidth : 0) {
  if (density.weights_of_pointings().empty()) {
    Factors<DenseCells> made(density.weights(), options);
    factor_ = std::move(made.of_cells);
    f2_ = {made.f2, made.f2};
    filled_ = made.filled;
  } else {
    factors_from(density.weights_of_pointings(), options, density.threads());
  }
}

void ImagingWeights::factors_from(const std::vector<CellTiles<double>>& density, const WeightingOptions& options, int threads) {
  std::vector<std::optional<Factors<CellTiles>>> made(density.size());
  parallel_for(density.size(), threads, [&](std::size_t p) { made[p].emplace(density[p], options); });
  factor_of_pointing_.reserve(density.size());
  for (std::optional<Factors<CellTiles>>& of_pointing : made) {
    filled_ += of_pointing->filled;
    if (const double f2 = of_pointing->f2; f2 > 0)
      f2_ = {f2_.least > 0 ? std::min(f2_.least, f2) : f2, std::max(f2_.largest, f2)};
    factor_of_pointing_.push_back(std::move(of_pointing->of_cells));
  }
}

WeightedBlock ImagingWeights::of(std::shared_ptr<const VisibilityBlock> block) const {
  WeightedBlock made;
  const std::shared_ptr<VisibilityBlock> first = own(std::move(block));
  weigh(*first, made.totals.sums);
  made.totals.w_spread.add(*first);
  made.block = first;
  return made;
}

WeightTotals ImagingWeights::put_on(StoredVisibilities& visibilities, int threads) const {
  std::vector<std::shared_ptr<const VisibilityBlock>>& blocks = visibilities.blocks();
  std::vector<WeightTotals> part(blocks.size());
  parallel_for(blocks.size(), threads, [&](std::size_t b) {
    WeightedBlock made = of(std::move(blocks[b]));
    blocks[b] = std::move(made.block);
    part[b] = made.totals;
  });
  WeightTotals totals;
  for (const WeightTotals& of_block : part) totals += of_block;
  return totals;
}

void ImagingWeights::weigh(VisibilityBlock& block, WeightSums& sums) const {
  const std::size_t channels = block.channels();
  const std::vector<double> turns = cells_.turns_per_m(block.frequency_hz);
  RowTaper taper(taper_, window_, block.frequency_hz);
  std::vector<std::uint32_t> cell(channels);
  const bool of_pointings = !factor_of_pointing_.empty();
  if (of_pointings) require_pointings(block, factor_of_pointing_.size());
  const float* const shared = factor_ ? factor_->data() : nullptr;
  for (std::size_t row = 0; row < block.rows(); ++row) {
    const CellTiles<float>* own = nullptr;
    if (of_pointings) {
      cells_.places_of_row(&block.uvw_m[3 * row], turns, cell.data());
      own = &factor_of_pointing_[static_cast<std::size_t>(block.sights[row].field)];
    } else {
      cells_.of_row(&block.uvw_m[3 * row], turns, cell.data());
    }
    taper.set_row(&block.uvw_m[3 * row]);
    for (std::size_t c = 0; c < channels; ++c) {
      float& weight = block.weight[row * channels + c];
      const double natural{weight};
      if (natural == 0) continue;
      weight = least;
      if (cell[c] == UvCells::outside) continue;
      double factor = 1;
      if (own != nullptr)
        factor = double{own->at(cell[c])};
      else if (shared != nullptr)
        factor = double{shared[cell[c]]};
      if (fractional_bandwidth_ > 0)
        factor = bandwidth_tapered(factor, fractional_bandwidth_ * cells_.distance(&block.uvw_m[3 * row], turns[c]));
      factor *= taper.at(c);
      weight = std::max(least, static_cast<float>(natural * factor));
      sums += {natural, natural * factor, natural * factor * factor};
    }
  }
}

std::shared_ptr<const ImagingWeights> make_imaging_weights(const VisibilitySource& source, const WeightingOptions& options,
                                                           const ImageGeometry& geometry, const Context& context) {
  if (options.none()) return nullptr;
  if (!options.needs_density()) return std::make_shared<ImagingWeights>(geometry, options);
  UvDensity density(geometry, context.threads, options.pointings);
  std::uint64_t done = 0;
  const auto stream = source.open();
  const auto next = [&] {
    const StageTimer timer(context.times, stage::read);
    return stream->next();
  };
  while (const auto block = next()) {
    const StageTimer timer(context.times, stage::weights);
    density.add(*block);
    done += block->samples();
    context.tell(done, source.samples());
  }
  source.end_pass();
  const StageTimer timer(context.times, stage::weights);
  density.add_up(source.ranks());
  return std::make_shared<ImagingWeights>(density, options);
}

}  // namespace misfit::imager
