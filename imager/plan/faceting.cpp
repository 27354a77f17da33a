#include "imager/plan/faceting.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "imager/wide/facet.h"

namespace misfit::imager {
namespace {

constexpr int smallest_facet = 128;

}  // namespace

int Faceting::planes(double padding_w, int width_w) const {
  double sum = 0;
  for (const double t : turns) sum += std::floor(padding_w * t + 0.5 * (width_w + 1));
  return static_cast<int>(std::min(sum, 1e9));
}

std::vector<Faceting> facetings(const ImageGeometry& image, double max_abs_w, int most) {
  std::vector<Faceting> ways;
  const int longest = std::max(image.width, image.height);
  for (int parts = 1; parts <= most && (parts == 1 || longest / parts >= smallest_facet); ++parts) {
    if (parts > 8 && parts % 4 != 0) continue;
    const auto share = [&](int pixels) { return std::max(1, static_cast<int>(std::lround(1.0 * parts * pixels / longest))); };
    Faceting way;
    way.along_l = share(image.width);
    way.along_m = share(image.height);
    way.width = largest_facet(image.width, way.along_l);
    way.height = largest_facet(image.height, way.along_m);
    for (const Facet& facet : split_into_facets(image, way.along_l, way.along_m))
      if (!facet.empty) way.turns.push_back(2 * facet.reach * max_abs_w);
    if (way.turns.empty()) throw std::invalid_argument("every pixel of the image lies beyond the horizon");
    ways.push_back(way);
    constexpr double few = 0.1;  // smaller facets would save no plane
    if (*std::max_element(way.turns.begin(), way.turns.end()) < few) break;
  }
  return ways;
}

}  // namespace misfit::imager
