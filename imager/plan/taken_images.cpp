#include "imager/plan/taken_images.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
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

constexpr double accuracies = 10;  ///< by which images may differ that two runs made

/// Of pixels that `middle` has.
void require_alike(const Image& image, const Image& middle, double most_rms, std::optional<std::size_t> stokes) {
  const int row = image.height / 2 - middle.height / 2, column = image.width / 2 - middle.width / 2;
  double square = 0, worst = -1;
  int compared = 0, worst_row = 0, worst_column = 0;
  for (int r = 0; r < middle.height; ++r)
    for (int c = 0; c < middle.width; ++c) {
      const double has = image.at(row + r, column + c), expected = middle.at(r, c);
      if (std::isnan(expected)) continue;
      const double difference = std::abs(has - expected);
      square += difference * difference;
      ++compared;
      if (difference <= worst) continue;
      worst = difference;
      worst_row = r;
      worst_column = c;
    }
  if (compared == 0 || std::sqrt(square / compared) <= most_rms) return;
  char what[160];
  std::snprintf(what, sizeof what, "is %.6g at pixel %d, %d, where these samples give %.6g",
                image.at(row + worst_row, column + worst_column), column + worst_column, row + worst_row,
                middle.at(worst_row, worst_column));
  throw UnlikeSamples(stokes, what);
}

double borne(const Image& dirty, const GriddingRequest& request) {
  constexpr double differs = 1e-2;
  return std::max(differs, accuracies * request.accuracy) * root_mean_square(dirty);
}

/// Takes P ⋆ I off the middle of an image; pixels that need more of P than there is become NaN. Returns Σ |I|.
double subtract_response(const Image& model, const Image& psf, Image& middle) {
  double flux = 0;
  const int row = model.height / 2 - middle.height / 2, column = model.width / 2 - middle.width / 2;
  for (int y = 0; y < model.height; ++y)
    for (int x = 0; x < model.width; ++x) {
      const double jy = model.at(y, x);
      if (jy == 0 || std::isnan(jy)) continue;
      flux += std::abs(jy);
      for (int r = 0; r < middle.height; ++r)
        for (int c = 0; c < middle.width; ++c) {
          const int from_row = psf.height / 2 + row + r - y, from_column = psf.width / 2 + column + c - x;
          const bool there = from_row >= 0 && from_row < psf.height && from_column >= 0 && from_column < psf.width;
          middle.at(r, c) -= there ? jy * psf.at(from_row, from_column) : std::numeric_limits<double>::quiet_NaN();
        }
    }
  return flux;
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

std::vector<Image> take(TakenImages taken, const GriddingRequest& request, const Ranks& ranks, DirtyImages& made) {
  constexpr double psf_differs = 1e-3;
  if (taken.psf) {
    if (ranks.first())
      require_alike(*taken.psf, made.psf, std::max(psf_differs, accuracies * request.psf_accuracy), std::nullopt);
    made.psf_statistics = replace(made.psf, *taken.psf, ranks);
  }
  std::vector<Image> middles;
  for (std::size_t s = 0; taken.dirty && s < made.dirty.size(); ++s) {
    Image& image = taken.dirty->at(s);
    if (ranks.first() && !taken.of_model) require_alike(image, made.dirty[s], borne(image, request), s);
    if (taken.of_model) middles.push_back(std::move(made.dirty[s]));
    made.dirty_statistics[s] = replace(made.dirty[s], image, ranks);
  }
  return middles;
}

void require_residual_of(const ModelResidual& of, const GriddingRequest& request, std::size_t stokes, const Image& residual) {
  Image expected = of.dirty_middle;
  double flux = 0;
  for (std::size_t t = 0; t < of.model.size(); ++t) flux += subtract_response(*of.model[t], *of.psf[t], expected);
  require_alike(residual, expected, borne(residual, request) + request.psf_accuracy * flux, stokes);
}

}  // namespace misfit::imager
