#include "imager/plan/taken_images.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "imager/direct/verify.h"

namespace misfit::imager {
namespace {

std::vector<Pixel> compared_pixels(const ImageGeometry& geometry, std::uint64_t samples) {
  constexpr double affordable = 4e7;  // sums of a sample and a pixel; more are taken where that is less than 16 pixels
  constexpr int near = 4;             // pixels in a row
  const int random = static_cast<int>(std::clamp(affordable / static_cast<double>(samples + 1), 16.0, 256.0));
  std::vector<Pixel> pixels = random_pixels(geometry, random);
  for (int r = 0; r < std::min(near, geometry.height); ++r)
    for (int c = 0; c < std::min(near, geometry.width); ++c)
      pixels.push_back({geometry.centre_row() - std::min(near, geometry.height) / 2 + r,
                        geometry.centre_column() - std::min(near, geometry.width) / 2 + c});
  return pixels;
}

DirectPixels direct_pixels(const GriddingPlan& plan, const std::vector<Pixel>& pixels) {
  return {plan.options.geometry, pixels, plan.direct || plan.options.has_w_axis(), plan.options.threads};
}

}  // namespace

ComparedPixels::ComparedPixels(const GriddingPlan& plan, const Transform& whole)
    : pixels_(compared_pixels(plan.options.geometry, plan.request.samples)), transform_(direct_pixels(plan, pixels_), whole) {}

void ComparedPixels::require(const Image& image, const Image& values, double rms, double accuracy,
                             const ImageKind& kind) const {
  constexpr double least = 1e-2, accuracies = 3, most = 0.1;
  const double borne = std::clamp(accuracies * accuracy, least, most) * rms;
  double square = 0, worst = 0;
  std::size_t at_worst = 0;
  int compared = 0;
  for (std::size_t k = 0; k < pixels_.size(); ++k) {
    const double has = image.at(pixels_[k].row, pixels_[k].column), expected = values.pixel[k];
    if (std::isnan(has) && std::isnan(expected)) continue;
    const double difference = std::isnan(has - expected) ? INFINITY : std::abs(has - expected);
    square += difference * difference;
    ++compared;
    if (!(difference > worst)) continue;
    worst = difference;
    at_worst = k;
  }
  if (square <= compared * borne * borne) return;
  char what[160];
  std::snprintf(what, sizeof what, "is %.6g at pixel %d, %d, where these samples give %.6g",
                image.at(pixels_[at_worst].row, pixels_[at_worst].column), pixels_[at_worst].column, pixels_[at_worst].row,
                values.pixel[at_worst]);
  throw UnlikeSamples(kind, what);
}

}  // namespace misfit::imager
