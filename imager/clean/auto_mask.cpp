#include "imager/clean/auto_mask.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "imager/clean/mask.h"
#include "imager/clean/region.h"
#include "imager/data/noise.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

Region above(const Image& image, double level, int threads) {
  return {image, threads, [level](double pixel) { return pixel > level; }};
}

struct Pieces {
  int all = 0;
  int dropped = 0;
};

/// Removes connected pieces of fewer pixels.
Pieces drop_small(double fewest_pixels, Region& region) {
  Pieces pieces;
  std::vector<char> seen(region.in.size());
  std::vector<std::size_t> piece;
  for (std::size_t first = 0; first < region.in.size(); ++first) {
    if (!region.in[first] || seen[first]) continue;
    piece.assign(1, first);
    seen[first] = 1;
    for (std::size_t i = 0; i < piece.size(); ++i)
      region.for_each_neighbour(piece[i], [&](std::size_t place) {
        if (region.in[place] && !seen[place]) piece.push_back(place);
        seen[place] |= region.in[place];
      });
    ++pieces.all;
    if (static_cast<double>(piece.size()) >= fewest_pixels) continue;
    ++pieces.dropped;
    for (const std::size_t place : piece) region.in[place] = 0;
  }
  return pieces;
}

/// Adds, `times` over, the neighbours that lie in `into`.
void grow(const Region& into, int times, Region& region) {
  std::vector<std::size_t> rim, next;
  for (std::size_t i = 0; i < region.in.size(); ++i)
    if (region.in[i]) rim.push_back(i);
  for (int step = 0; step < times && !rim.empty(); ++step, rim.swap(next)) {
    next.clear();
    for (const std::size_t place : rim)
      region.for_each_neighbour(place, [&](std::size_t neighbour) {
        if (region.in[neighbour] || !into.in[neighbour]) return;
        region.in[neighbour] = 1;
        next.push_back(neighbour);
      });
  }
}

void keep_within(const Region& other, Region& region) {
  for (std::size_t i = 0; i < region.in.size(); ++i) region.in[i] &= other.in[i];
}

/// z with count · erfc(z/√2) = ½, by bisection.
double chauvenet_deviations(double count) {
  double low = 0, high = 40;
  for (int step = 0; step < 60; ++step) {
    const double z = 0.5 * (low + high);
    (count * std::erfc(z / std::sqrt(2.0)) > 0.5 ? low : high) = z;
  }
  return low;
}

/// One extension of a mask.
class Extension {
 public:
  Extension(const Image& residual, const AutoMaskOptions& options, const AutoMaskScene& scene)
      : residual_(residual), o_(options), scene_(scene) {
    const double peak = largest_magnitude(scene.within == nullptr ? residual : masked(residual, *scene.within));
    const double noise = scene.noise_jy, sidelobes = o_.sidelobe_threshold * scene.max_sidelobe * peak;
    high_ = std::max(sidelobes, o_.noise_threshold * noise);
    low_ = std::max(sidelobes, o_.low_noise_threshold * noise);
    deep_ = -std::max(sidelobes, o_.negative_threshold * noise);
    told_.threshold_jy = high_;
    told_.by_sidelobes = sidelobes > o_.noise_threshold * noise;
    fewest_pixels_ = o_.min_beam_fraction * M_PI / (4 * std::log(2.0)) * scene.beam.major_rad * scene.beam.minor_rad /
                     (scene.cell_rad * scene.cell_rad);
  }

  Region bright() {
    Region region = above(residual_, high_, scene_.threads);
    const Pieces pieces = drop_small(fewest_pixels_, region);
    told_.regions = pieces.all;
    told_.pruned = pieces.dropped;
    spread(region);
    return region;
  }

  /// Grows the mask so far, without the part that absorption made.
  Region grown(Region region) {
    const Region faint = above(residual_, low_, scene_.threads);
    grow(faint, o_.grow_iterations, region);
    keep_within(faint, region);
    const Pieces pieces = drop_small(o_.grow_prune ? fewest_pixels_ : 0, region);
    told_.grown_regions = pieces.all;
    told_.grown_pruned = pieces.dropped;
    spread(region);
    return region;
  }

  Region absorption() {
    Region region(residual_, scene_.threads, [this](double pixel) { return pixel <= deep_ && pixel < 0; });
    told_.negative = static_cast<std::size_t>(std::count(region.in.begin(), region.in.end(), 1));
    spread(region);
    return region;
  }

  const MaskExtension& told() const { return told_; }

 private:
  void spread(Region& region) const {
    if (o_.smooth_factor == 0) return;
    Beam beam = scene_.beam;
    beam.major_rad *= o_.smooth_factor;
    beam.minor_rad *= o_.smooth_factor;
    smooth_and_cut({beam, scene_.cell_rad, o_.cut_threshold, scene_.threads}, region);
  }

  const Image& residual_;
  const AutoMaskOptions& o_;
  const AutoMaskScene& scene_;
  double high_, low_, deep_;
  double fewest_pixels_;
  MaskExtension told_;
};

/// Leaves out, as often as there are any, pixels farther from the mean than one of so many would be in half of all draws from a
/// Gaussian.
void drop_outliers(Image& image) {
  for (;;) {
    double count = 0, sum = 0, square = 0;
    for (const double pixel : image.pixel)
      if (!std::isnan(pixel)) {
        ++count;
        sum += pixel;
      }
    const double mean = sum / count;
    for (const double pixel : image.pixel)
      if (!std::isnan(pixel)) square += (pixel - mean) * (pixel - mean);
    const double farthest = chauvenet_deviations(count) * std::sqrt(square / (count - 1));
    bool dropped = false;
    for (double& pixel : image.pixel)
      if (std::abs(pixel - mean) > farthest) {
        pixel = std::numeric_limits<double>::quiet_NaN();
        dropped = true;
      }
    if (!dropped) return;
  }
}

}  // namespace

MaskExtension extend_mask(const Image& residual, const AutoMaskOptions& options, const AutoMaskScene& scene,
                          GrowingMask& mask) {
  std::vector<double>&allowed = mask.allowed.pixel, &negative = mask.negative.pixel;
  const bool absorbs = options.negative_threshold > 0;
  if (absorbs && negative.empty()) mask.negative = Image(mask.allowed.width, mask.allowed.height);
  Region positive(mask.allowed, scene.threads, mask_allows);
  for (std::size_t i = 0; i < negative.size(); ++i) positive.in[i] &= negative[i] == 0;
  Extension extension(residual, options, scene);
  const Region bright = extension.bright(), grown = extension.grown(positive);
  std::optional<Region> absorption;
  if (absorbs) absorption = extension.absorption();
  std::vector<std::size_t> added(static_cast<std::size_t>(residual.height));  // [row]
  parallel_for(added.size(), scene.threads, [&](std::size_t r) {
    const auto width = static_cast<std::size_t>(residual.width);
    for (std::size_t i = r * width; i < (r + 1) * width; ++i) {
      const bool was = mask_allows(allowed[i]);
      const bool may = !std::isnan(residual.pixel[i]) && (scene.within == nullptr || mask_allows(scene.within->pixel[i]));
      const bool in_positive = may && (positive.in[i] || bright.in[i] || grown.in[i]);
      const bool in_negative = may && !in_positive && absorbs && (negative[i] != 0 || absorption->in[i]);
      allowed[i] = in_positive || in_negative ? 1 : 0;
      if (absorbs) negative[i] = in_negative ? 1 : 0;
      added[r] += (in_positive || in_negative) && !was ? 1 : 0;
    }
  });
  MaskExtension told = extension.told();
  for (const std::size_t pixels : added) told.added += pixels;
  return told;
}

double mask_noise(const Image& residual, const Image& mask, const Image* within, int threads) {
  Image kept = within == nullptr || mask_is_empty(*within) ? residual : masked(residual, *within);
  const auto counts = [&](std::size_t i) { return !mask_allows(mask.pixel[i]) && !std::isnan(kept.pixel[i]); };
  std::size_t outside = 0;
  for (std::size_t i = 0; i < kept.pixel.size(); ++i) outside += counts(i) ? 1 : 0;
  if (outside == 0 || mask_is_empty(mask)) {
    drop_outliers(kept);
  } else {
    for (std::size_t i = 0; i < kept.pixel.size(); ++i)
      if (!counts(i)) kept.pixel[i] = std::numeric_limits<double>::quiet_NaN();
  }
  return robust_noise(kept, threads);
}

}  // namespace misfit::imager
