#include "imager/clean/auto_mask.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "imager/clean/gaussian_blur.h"
#include "imager/data/noise.h"

BOOST_AUTO_TEST_SUITE(auto_mask)

using namespace misfit::imager;

namespace {

constexpr int side = 100;
const AutoMaskScene scene{.max_sidelobe = 0.01, .noise_jy = 1, .beam = {4, 4, 0}, .cell_rad = 1, .threads = 1};

/// A Gaussian of this peak and width.
Image source(int row, int column, double peak, double fwhm) {
  Image image(side, side);
  image.at(row, column) = 1;
  image = gaussian_blur(image, fwhm, 1);
  const double scale = peak / image.at(row, column);
  for (double& pixel : image.pixel) pixel *= scale;
  return image;
}

Image operator+(Image a, const Image& b) {
  for (std::size_t i = 0; i < a.pixel.size(); ++i) a.pixel[i] += b.pixel[i];
  return a;
}

GrowingMask growing_from(const Image& residual, const AutoMaskOptions& options = {}, const AutoMaskScene& of = scene) {
  GrowingMask mask{Image(side, side), {}};
  extend_mask(residual, options, of, mask);
  return mask;
}

Image mask_of(const Image& residual, const AutoMaskOptions& options = {}, const AutoMaskScene& of = scene) {
  return growing_from(residual, options, of).allowed;
}

double pixels(const Image& mask) {
  return std::accumulate(mask.pixel.begin(), mask.pixel.end(), 0.0);
}

}  // namespace

BOOST_AUTO_TEST_CASE(sources_above_the_noise_threshold_are_in_and_those_below_are_not) {
  const Image mask = mask_of(source(30, 40, 10, 4) + source(70, 20, 4.9, 4));
  BOOST_TEST(mask.at(30, 40) == 1);
  BOOST_TEST(mask.at(70, 20) == 0);
}

BOOST_AUTO_TEST_CASE(sources_below_the_sidelobes_of_the_brightest_are_not_in) {
  const Image sky = source(30, 40, 1000, 4) + source(70, 20, 29, 4);
  BOOST_TEST(mask_of(sky).at(30, 40) == 1);
  BOOST_TEST(mask_of(sky).at(70, 20) == 0);  // below 3 × 0.01 × 1000
  BOOST_TEST(mask_of(sky, {.sidelobe_threshold = 2}).at(70, 20) == 1);
}

BOOST_AUTO_TEST_CASE(what_is_smaller_than_a_part_of_the_beam_is_dropped) {
  Image sky = source(30, 40, 20, 4);
  sky.at(80, 80) = 20;  // a spike of noise
  const Image mask = mask_of(sky);
  BOOST_TEST(mask.at(30, 40) == 1);
  BOOST_TEST(mask.at(80, 80) == 0);
  BOOST_TEST(mask_of(sky, {.min_beam_fraction = 0}).at(80, 80) == 1);
}

BOOST_AUTO_TEST_CASE(a_region_reaches_about_a_beam_beyond_its_pixels) {
  Image sky(side, side);
  for (int r = 40; r < 60; ++r)
    for (int c = 40; c < 60; ++c) sky.at(r, c) = 10;
  const Image mask = mask_of(sky);
  BOOST_TEST(mask.at(50, 40 - 3) == 1);
  BOOST_TEST(mask.at(50, 40 - 6) == 0);
}

BOOST_AUTO_TEST_CASE(what_was_in_stays_and_grows_into_the_faint) {
  const Image bright = source(50, 50, 10, 4), faint = source(50, 50, 4, 30);
  GrowingMask mask = growing_from(bright);
  const double before = pixels(mask.allowed);
  extend_mask(faint, {}, scene, mask);
  BOOST_TEST(mask.allowed.at(50, 66) == 1);  // above 1.5 σ, connected with what was in
  BOOST_TEST(pixels(mask.allowed) > 2 * before);
  GrowingMask apart = growing_from(source(5, 5, 10, 4));
  extend_mask(faint, {}, scene, apart);
  BOOST_TEST(apart.allowed.at(50, 50) == 0);  // not connected
  BOOST_TEST(apart.allowed.at(5, 5) == 1);
  GrowingMask slow = growing_from(bright);
  extend_mask(faint, {.grow_iterations = 2}, scene, slow);
  BOOST_TEST(slow.allowed.at(50, 66) == 0);
}

BOOST_AUTO_TEST_CASE(neither_nan_nor_negative_pixels_are_ever_in) {
  Image sky = source(30, 40, 20, 4) + source(70, 20, -20, 4);
  sky.at(30, 41) = std::numeric_limits<double>::quiet_NaN();
  const Image mask = mask_of(sky);
  BOOST_TEST(mask.at(30, 40) == 1);
  BOOST_TEST(mask.at(30, 41) == 0);
  BOOST_TEST(mask.at(70, 20) == 0);
}

BOOST_AUTO_TEST_CASE(noise_alone_leaves_the_mask_empty) {
  BOOST_TEST(pixels(mask_of(Image(side, side))) == 0);
}

namespace {

/// The algorithm as tclean's documentation has it, plain and slow: masks of 0 and 1 [row][column], every sum over all pixels.
class Documented {
 public:
  Documented(const AutoMaskOptions& options, const AutoMaskScene& of) : o_(options), scene_(of) {}

  using Mask = std::vector<std::vector<int>>;
  Mask positive = Mask(side, std::vector<int>(side)), negative = positive;
  /// Pixels that a rounding could put in or out.
  Mask undecided = positive;

  void extend(const Image& residual) {
    double peak = 0;
    for (const double pixel : residual.pixel) peak = std::max(peak, std::abs(pixel));
    const double sidelobes = o_.sidelobe_threshold * scene_.max_sidelobe * peak;
    const Mask bright = smoothed(
        pruned(where(residual, [&](double x) { return x > std::max(sidelobes, o_.noise_threshold * scene_.noise_jy); })));
    const Mask constraint =
        where(residual, [&](double x) { return x > std::max(sidelobes, o_.low_noise_threshold * scene_.noise_jy); });
    Mask low = dilated(positive, constraint);
    for (int r = 0; r < side; ++r)
      for (int c = 0; c < side; ++c) low[r][c] *= constraint[r][c];
    low = smoothed(o_.grow_prune ? pruned(low) : low);
    Mask absorption(side, std::vector<int>(side));
    if (o_.negative_threshold > 0)
      absorption = smoothed(
          where(residual, [&](double x) { return x <= -std::max(sidelobes, o_.negative_threshold * scene_.noise_jy); }));
    for (int r = 0; r < side; ++r)
      for (int c = 0; c < side; ++c) {
        positive[r][c] |= bright[r][c] | low[r][c];
        negative[r][c] |= absorption[r][c];
      }
  }

 private:
  template <typename Of>
  static Mask where(const Image& image, const Of& of) {
    Mask mask(side, std::vector<int>(side));
    for (int r = 0; r < side; ++r)
      for (int c = 0; c < side; ++c) mask[r][c] = of(image.at(r, c)) ? 1 : 0;
    return mask;
  }

  static bool in(const Mask& mask, int r, int c) { return r >= 0 && c >= 0 && r < side && c < side && mask[r][c] != 0; }
  static bool touches(const Mask& mask, int r, int c) {
    return in(mask, r - 1, c) || in(mask, r + 1, c) || in(mask, r, c - 1) || in(mask, r, c + 1);
  }

  /// Labels spread from pixel to pixel until none changes.
  Mask pruned(Mask mask) const {
    Mask label(side, std::vector<int>(side));
    for (int r = 0; r < side; ++r)
      for (int c = 0; c < side; ++c) label[r][c] = mask[r][c] ? 1 + r * side + c : 0;
    for (bool changed = true; changed;) {
      changed = false;
      for (int r = 0; r < side; ++r)
        for (int c = 0; c < side; ++c)
          for (const auto& [dr, dc] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
            if (mask[r][c] && in(mask, r + dr, c + dc) && label[r + dr][c + dc] < label[r][c]) {
              label[r][c] = label[r + dr][c + dc];
              changed = true;
            }
    }
    std::map<int, int> size;
    for (const auto& row : label)
      for (const int one : row) ++size[one];
    const double beam_area = M_PI * scene_.beam.major_rad * scene_.beam.minor_rad / (4 * std::log(2.0));  // cells are 1
    for (int r = 0; r < side; ++r)
      for (int c = 0; c < side; ++c)
        if (size[label[r][c]] < o_.min_beam_fraction * beam_area) mask[r][c] = 0;
    return mask;
  }

  Mask dilated(Mask mask, const Mask& constraint) const {
    for (int step = 0; step < o_.grow_iterations; ++step) {
      Mask next = mask;
      for (int r = 0; r < side; ++r)
        for (int c = 0; c < side; ++c)
          if (constraint[r][c] && touches(mask, r, c)) next[r][c] = 1;
      if (next == mask) break;
      mask = next;
    }
    return mask;
  }

  Mask smoothed(const Mask& mask) {
    const double pa = scene_.beam.position_angle_rad, factor = o_.smooth_factor * o_.smooth_factor / (4 * std::log(2.0));
    const double major2 = factor * std::pow(scene_.beam.major_rad, 2), minor2 = factor * std::pow(scene_.beam.minor_rad, 2);
    std::vector<double> beam;  // [north + side][west + side]
    for (int north = -side; north < side; ++north)
      for (int west = -side; west < side; ++west) {
        const double along = north * std::cos(pa) - west * std::sin(pa), across = -north * std::sin(pa) - west * std::cos(pa);
        beam.push_back(std::exp(-along * along / major2 - across * across / minor2));
      }
    std::vector<std::vector<double>> sum(side, std::vector<double>(side));
    double largest = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        for (int r = 0; mask[y][x] != 0 && r < side; ++r)
          for (int c = 0; c < side; ++c) sum[r][c] += beam[static_cast<std::size_t>((r - y + side) * 2 * side + c - x + side)];
    for (const auto& row : sum) largest = std::max(largest, *std::max_element(row.begin(), row.end()));
    Mask cut(side, std::vector<int>(side));
    for (int r = 0; largest > 0 && r < side; ++r)
      for (int c = 0; c < side; ++c) {
        cut[r][c] = sum[r][c] > o_.cut_threshold * largest ? 1 : 0;
        if (std::abs(sum[r][c] - o_.cut_threshold * largest) < 1e-5 * o_.cut_threshold * largest) undecided[r][c] = 1;
      }
    return cut;
  }

  AutoMaskOptions o_;
  AutoMaskScene scene_;
};

/// Noise of 1 Jy/beam seen with the beam, and what is in it.
Image observed(const std::vector<Image>& sky, unsigned seed, const AutoMaskScene& of) {
  std::minstd_rand random(seed);
  std::normal_distribution<double> normal;
  Image image(side, side);
  for (double& pixel : image.pixel) pixel = normal(random);
  image = convolve_with_beam(image, of.beam, of.cell_rad, 1);
  const double rms = root_mean_square(image);
  for (double& pixel : image.pixel) pixel /= rms;
  for (const Image& each : sky) image = image + each;
  return image;
}

}  // namespace

/// Emission with something faint around it, absorption beside it, and a line that moves from plane to plane; by several
/// residuals each, of which CLEAN has taken more and more.
BOOST_AUTO_TEST_CASE(masks_are_those_of_the_documented_algorithm) {
  AutoMaskScene of = scene;
  of.beam = {5, 3.5, 0.6};
  const std::vector<std::vector<Image>> scenes{{source(50, 40, 60, 5), source(48, 45, 8, 30), source(80, 80, 7, 4)},
                                               {source(50, 40, 30, 6), source(30, 60, -25, 8), source(75, 20, -7, 20)}};
  std::vector<std::vector<Image>> planes = scenes;
  for (int plane = 0; plane < 3; ++plane) planes.push_back({source(40 + 5 * plane, 50, 4 + 6.0 * plane, 6)});
  const AutoMaskOptions usual{}, other{.sidelobe_threshold = 1,
                                       .noise_threshold = 4.25,
                                       .low_noise_threshold = 2,
                                       .negative_threshold = 7,
                                       .smooth_factor = 1.5,
                                       .cut_threshold = 0.1,
                                       .min_beam_fraction = 0.6,
                                       .grow_iterations = 5,
                                       .grow_prune = false};
  unsigned seed = 1;
  for (const std::vector<Image>& sky : planes)
    for (const AutoMaskOptions& options : {usual, other}) {
      Documented expected(options, of);
      GrowingMask mask{Image(side, side), {}};
      for (const double left : {1.0, 0.5, 0.2}) {
        std::vector<Image> remaining = sky;
        for (Image& image : remaining)
          for (double& pixel : image.pixel) pixel *= left;
        const Image residual = observed(remaining, seed++, of);
        expected.extend(residual);
        extend_mask(residual, options, of, mask);
        int unlike = 0, in = 0;
        for (int r = 0; r < side; ++r)
          for (int c = 0; c < side; ++c) {
            const bool is = mask.allowed.at(r, c) == 1, should = expected.positive[r][c] || expected.negative[r][c];
            unlike += is != should && !expected.undecided[r][c] ? 1 : 0;
            in += should ? 1 : 0;
          }
        BOOST_TEST(unlike == 0);
        if (left == 1) BOOST_TEST((in > 20 || sky.size() == 1));
      }
    }
}

BOOST_AUTO_TEST_CASE(absorption_is_masked_but_does_not_grow) {
  const Image deep = source(50, 50, -10, 4), faint = source(50, 50, -4, 30);
  const AutoMaskOptions options{.negative_threshold = 5};
  GrowingMask mask = growing_from(deep, options);
  const double before = pixels(mask.allowed);
  BOOST_TEST(mask.allowed.at(50, 50) == 1);
  BOOST_TEST(pixels(mask.negative) == before);
  extend_mask(faint, options, scene, mask);
  BOOST_TEST(pixels(mask.allowed) == before);
}

BOOST_AUTO_TEST_CASE(masks_keep_within_limits) {
  Image within(side, side);
  for (int r = 0; r < 50; ++r)
    for (int c = 0; c < side; ++c) within.at(r, c) = 1;
  AutoMaskScene of = scene;
  of.within = &within;
  const Image mask = mask_of(source(49, 40, 20, 6) + source(70, 40, 20, 6), {}, of);
  BOOST_TEST(mask.at(49, 40) == 1);
  for (int r = 50; r < side; ++r)
    for (int c = 0; c < side; ++c) BOOST_TEST_REQUIRE(mask.at(r, c) == 0);
}

/// Where sources fill half of the image, the deviation of all its pixels is theirs.
BOOST_AUTO_TEST_CASE(the_noise_of_masks_leaves_sources_out) {
  Image image = observed({}, 7, scene), mask(side, side);
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < 60; ++c) {
      image.at(r, c) += 100;
      mask.at(r, c) = 1;
    }
  BOOST_TEST(robust_noise(image) > 2.5);
  BOOST_TEST(std::abs(mask_noise(image, mask, nullptr, 1) - 1) < 0.1);  // of 4000 pixels, some 280 beams
  Image spikes = observed({}, 8, scene);
  const double quiet = mask_noise(spikes, Image(side, side), nullptr, 1);
  for (int i = 0; i < 300; ++i) spikes.pixel[static_cast<std::size_t>(33 * i)] += 50;
  BOOST_TEST(std::abs(mask_noise(spikes, Image(side, side), nullptr, 1) / quiet - 1) < 0.03);  // of a thirtieth fewer pixels
}

/// Pixels beyond, ten times as noisy, do not count, before there is a mask and after.
BOOST_AUTO_TEST_CASE(the_noise_of_masks_is_that_within_limits) {
  Image image = observed({}, 9, scene), within(side, side), mask(side, side), inner(60, side), inner_mask(60, side);
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      const bool is_within = c < 60;
      if (r < 20 && c < 70) {
        image.at(r, c) += 100;
        mask.at(r, c) = 1;
      }
      if (!is_within) image.at(r, c) *= 10;
      if (!is_within) continue;
      within.at(r, c) = 1;
      inner.at(r, c) = image.at(r, c);
      inner_mask.at(r, c) = mask.at(r, c);
    }
  const Image none(side, side);
  BOOST_TEST(mask_noise(image, mask, &within, 1) == mask_noise(inner, inner_mask, nullptr, 1));
  BOOST_TEST(mask_noise(image, none, &within, 1) == mask_noise(inner, Image(60, side), nullptr, 1));
  BOOST_TEST(mask_noise(image, mask, nullptr, 1) > 2 * mask_noise(image, mask, &within, 1));
  BOOST_TEST(mask_noise(image, mask, &none, 1) == mask_noise(image, mask, nullptr, 1));
  BOOST_TEST(mask_noise(image, within, &within, 1) == mask_noise(image, none, &within, 1));  // no pixel is outside
}

BOOST_AUTO_TEST_SUITE_END()
