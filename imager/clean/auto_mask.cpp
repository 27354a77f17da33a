#include "imager/clean/auto_mask.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "imager/clean/gaussian_blur.h"
#include "imager/clean/mask.h"
#include "imager/data/noise.h"

namespace misfit::imager {
namespace {

/// Pixels of an image that stand for true.
struct Region {
  int width = 0;
  int height = 0;
  std::vector<char> in;  ///< [height][width]

  explicit Region(const Image& like) : width(like.width), height(like.height), in(like.pixel.size()) {}

  /// Calls visit(place) for the up to four neighbours of a place.
  template <typename Visit>
  void for_each_neighbour(std::size_t place, const Visit& visit) const {
    const auto columns = static_cast<std::size_t>(width);
    if (place >= columns) visit(place - columns);
    if (place + columns < in.size()) visit(place + columns);
    if (place % columns != 0) visit(place - 1);
    if (place % columns + 1 != columns) visit(place + 1);
  }
};

Region above(const Image& image, double level) {
  Region result(image);
  for (std::size_t i = 0; i < result.in.size(); ++i) result.in[i] = image.pixel[i] > level;
  return result;
}

/// Takes out what is connected over fewer pixels.
void drop_small(double fewest_pixels, Region& region) {
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
    if (static_cast<double>(piece.size()) < fewest_pixels)
      for (const std::size_t place : piece) region.in[place] = 0;
  }
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

/// What the beam carries beyond its edges, down to a hundredth of the largest.
void spread(double beam_fwhm_pixels, int threads, Region& region) {
  constexpr double cut = 0.01;
  Image image(region.width, region.height);
  std::copy(region.in.begin(), region.in.end(), image.pixel.begin());
  if (std::find(region.in.begin(), region.in.end(), 1) == region.in.end()) return;
  image = gaussian_blur(image, beam_fwhm_pixels, threads);
  region = above(image, cut * *std::max_element(image.pixel.begin(), image.pixel.end()));
}

}  // namespace

void extend_mask(const Image& residual, const AutoMaskOptions& options, const AutoMaskScene& scene, Image& mask) {
  const double sidelobes = options.sidelobe_threshold * scene.max_sidelobe * largest_magnitude(residual);
  Region found = above(residual, std::max(sidelobes, options.noise_threshold * scene.noise_jy));
  const double beam_area = M_PI / (4 * std::log(2.0)) * scene.beam_fwhm_pixels * scene.beam_fwhm_pixels;
  drop_small(options.min_beam_fraction * beam_area, found);
  spread(scene.beam_fwhm_pixels, scene.threads, found);
  Region old(mask);
  std::transform(mask.pixel.begin(), mask.pixel.end(), old.in.begin(), mask_allows);
  grow(above(residual, std::max(sidelobes, options.low_noise_threshold * scene.noise_jy)), options.grow_iterations, old);
  for (std::size_t i = 0; i < mask.pixel.size(); ++i)
    mask.pixel[i] = (found.in[i] || old.in[i]) && !std::isnan(residual.pixel[i]) ? 1 : 0;
}

}  // namespace misfit::imager
