#include "imager/plan/taken_images.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "imager/direct/direct_transform.h"

namespace misfit::imager {
namespace {

/// The middle of an image as large as can be summed for so many samples, with the same pixel in its own middle.
ImageGeometry middle_of(ImageGeometry geometry, std::uint64_t samples) {
  constexpr double affordable = 4e7;  // sums, as in a tenth of a second
  const int side = static_cast<int>(std::clamp(std::sqrt(affordable / static_cast<double>(samples + 1)), 4.0, 16.0));
  geometry.width = std::min(geometry.width, side);
  geometry.height = std::min(geometry.height, side);
  return geometry;
}

void require_alike(const Image& image, const Image& middle, double most_rms, std::optional<std::size_t> stokes) {
  const int row = image.height / 2 - middle.height / 2, column = image.width / 2 - middle.width / 2;
  double square = 0, worst = -1;
  int worst_row = 0, worst_column = 0;
  for (int r = 0; r < middle.height; ++r)
    for (int c = 0; c < middle.width; ++c) {
      const double has = image.at(row + r, column + c), expected = middle.at(r, c);
      if (std::isnan(has) && std::isnan(expected)) continue;  // beyond the horizon
      const double difference = std::abs(has - expected);
      square += difference * difference;
      if (difference <= worst) continue;
      worst = difference;
      worst_row = r;
      worst_column = c;
    }
  if (std::sqrt(square / static_cast<double>(middle.pixel.size())) <= most_rms) return;
  char what[160];
  std::snprintf(what, sizeof what, "is %.6g at pixel %d, %d, where these samples give %.6g",
                image.at(row + worst_row, column + worst_column), column + worst_column, row + worst_row,
                middle.at(worst_row, worst_column));
  throw UnlikeSamples(stokes, what);
}

/// Becomes `taken`, at rank 0, whose statistics all ranks have.
ImageStatistics replace(Image& image, Image& taken, const Ranks& ranks) {
  image = std::move(taken);
  ImageStatistics statistics = statistics_of(image);
  share_values(ranks, statistics);
  return statistics;
}

}  // namespace

std::unique_ptr<Transform> middle_transform(const GriddingPlan& plan) {
  const WideTransformOptions& o = plan.options;
  return std::make_unique<DirectTransform>(
      DirectSums{middle_of(o.geometry, plan.request.samples), plan.direct || o.has_w_axis(), o.threads});
}

void take(TakenImages taken, const GriddingRequest& request, const Ranks& ranks, DirtyImages& made) {
  constexpr double psf_differs = 1e-3, dirty_differs = 1e-2, accuracies = 10;
  if (taken.psf) {
    if (ranks.first())
      require_alike(*taken.psf, made.psf, std::max(psf_differs, accuracies * request.psf_accuracy), std::nullopt);
    made.psf_statistics = replace(made.psf, *taken.psf, ranks);
  }
  for (std::size_t s = 0; taken.dirty && s < made.dirty.size(); ++s) {
    Image& image = taken.dirty->at(s);
    const double most = std::max(dirty_differs, accuracies * request.accuracy) * root_mean_square(image);
    if (ranks.first() && !taken.of_model) require_alike(image, made.dirty[s], most, s);
    made.dirty_statistics[s] = replace(made.dirty[s], image, ranks);
  }
}

}  // namespace misfit::imager
