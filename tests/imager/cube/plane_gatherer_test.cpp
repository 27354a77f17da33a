#include "imager/cube/plane_gatherer.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(plane_gatherer)

using namespace misfit::imager;

namespace {

constexpr std::size_t rows = 60, channels = 8;
constexpr double first_hz = 1e9, channel_hz = 1e6;

/// A block of two Stokes parameters of which some samples are unusable. Every ten rows have another frame ratio.
VisibilityBlock block_of(unsigned seed) {
  const auto random = [&](unsigned of) {
    VisibilityBlock block = testing::random_samples(rows, channels, 1e-5, of);
    for (std::size_t c = 0; c < channels; ++c) block.frequency_hz[c] = first_hz + channel_hz * static_cast<double>(c);
    return block;
  };
  VisibilityBlock block = random(seed);
  for (std::size_t i = 0; i < block.samples(); i += 7) block.weight[i] = 0;
  std::fill_n(block.weight.begin() + 5 * channels, channels, 0.0F);  // a row of nothing
  block.channel_width_hz.assign(channels, channel_hz);
  for (std::size_t row = 0; row < rows; ++row) block.frame_ratio.push_back(1 + 1e-4 * static_cast<double>(row / 10));
  const VisibilityBlock other = random(seed + 100);
  block.visibility.insert(block.visibility.end(), other.visibility.begin(), other.visibility.end());
  return block;
}

CubeSampling cube(SpectralInterpolation how, double width_hz = channel_hz) {
  return {{first_hz + 0.3e6, width_hz, 6, "LSRK", 0}, how};
}

struct Sample {
  double u_lambda, v_lambda, w_lambda;
  std::complex<double> one, other;
  double weight;
};

std::vector<Sample> samples_of(const std::vector<std::shared_ptr<const VisibilityBlock>>& blocks) {
  std::vector<Sample> all;
  for (const auto& block : blocks)
    for (std::size_t row = 0; row < block->rows(); ++row)
      for (std::size_t c = 0; c < block->channels(); ++c) {
        const std::size_t i = row * block->channels() + c;
        if (block->weight[i] == 0) continue;
        const double per_m = block->frequency_hz[c] / misfit::imager::speed_of_light_m_s;
        all.push_back({block->uvw_m[3 * row] * per_m, block->uvw_m[3 * row + 1] * per_m, block->uvw_m[3 * row + 2] * per_m,
                       block->visibility[i], block->visibility_of(1)[i], block->weight[i]});
      }
  return all;
}

/// By the definitions of SpectralInterpolation, for planes no wider than channels: of one row and plane, if there is one.
std::vector<Sample> expected_sample(const VisibilityBlock& block, const CubeSampling& cube, int plane, std::size_t row) {
  const double ratio = block.frame_ratio[row];
  const double middle_hz = cube.axis.frequency_hz(plane) / ratio;  // in the data's frame
  const double at = (middle_hz - first_hz) / channel_hz;
  const auto sample = [&](std::size_t c) { return row * channels + c; };
  const auto made = [&](double hz, std::complex<double> one, std::complex<double> other, double weight) {
    const double per_m = hz / speed_of_light_m_s;
    return Sample{
        block.uvw_m[3 * row] * per_m, block.uvw_m[3 * row + 1] * per_m, block.uvw_m[3 * row + 2] * per_m, one, other, weight};
  };
  const std::complex<float>* const second = block.visibility_of(1);
  if (at < -0.5 || at > channels - 0.5) return {};
  if (cube.interpolation == SpectralInterpolation::nearest) {
    const std::size_t c = sample(static_cast<std::size_t>(std::lround(at)));
    if (block.weight[c] == 0) return {};
    return {made(block.frequency_hz[c % channels], block.visibility[c], second[c], block.weight[c])};
  }
  const double low = std::clamp(std::floor(at), 0.0, channels - 2.0);
  const double t = std::clamp(at - low, 0.0, 1.0);
  const std::size_t a = sample(static_cast<std::size_t>(low)), b = a + 1;
  if ((t < 1 && block.weight[a] == 0) || (t > 0 && block.weight[b] == 0)) return {};
  const auto mixed = [&](const auto& v) { return (1 - t) * std::complex<double>(v[a]) + t * std::complex<double>(v[b]); };
  const double variance = (t < 1 ? (1 - t) * (1 - t) / block.weight[a] : 0) + (t > 0 ? t * t / block.weight[b] : 0);
  return {made(middle_hz, mixed(block.visibility), mixed(second), 1 / variance)};
}

bool same_bits(const VisibilityBlock& a, const VisibilityBlock& b) {
  return a.uvw_m == b.uvw_m && a.frequency_hz == b.frequency_hz && a.visibility == b.visibility && a.weight == b.weight;
}

bool same_bits(const StoredVisibilities& a, const StoredVisibilities& b) {
  const auto one = a.open(), other = b.open();
  while (true) {
    const auto x = one->next(), y = other->next();
    if (!x || !y) return !x && !y;
    if (!same_bits(*x, *y)) return false;
  }
}

StoredVisibilities two_blocks() {
  StoredVisibilities source;
  for (const unsigned seed : {1U, 2U}) source.append(std::make_shared<VisibilityBlock>(block_of(seed)));
  return source;
}

std::vector<std::shared_ptr<const VisibilityBlock>> blocks_of(PlaneGatherer& gatherer, int plane) {
  std::vector<std::shared_ptr<const VisibilityBlock>> blocks;
  for (const auto& some : gatherer.take(true))
    for (auto& block : some->blocks(plane)) blocks.push_back(std::move(block));
  return blocks;
}

GatheredPlanes gathered(const VisibilitySource& source, const CubeSampling& sampling, const PlaneRange& range, int threads) {
  return gather_planes(source, sampling, range, {threads});
}

}  // namespace

BOOST_AUTO_TEST_CASE(samples_are_those_of_the_definition) {
  for (const auto how : {SpectralInterpolation::nearest, SpectralInterpolation::linear}) {
    const CubeSampling sampling = cube(how);
    const VisibilityBlock block = block_of(3);
    for (int plane = 0; plane < 6; ++plane) {
      PlaneGatherer gatherer(sampling, {0, 6}, 2);
      gatherer.add(block);
      BOOST_TEST_CONTEXT((how == SpectralInterpolation::nearest ? "nearest" : "linear") << ", plane " << plane) {
        std::vector<Sample> expected;
        for (std::size_t row = 0; row < rows; ++row)
          for (const Sample& sample : expected_sample(block, sampling, plane, row)) expected.push_back(sample);
        std::vector<Sample> taken = samples_of(blocks_of(gatherer, plane));
        BOOST_TEST_REQUIRE(taken.size() == expected.size());
        const auto by_u = [](const Sample& a, const Sample& b) { return a.u_lambda < b.u_lambda; };
        std::sort(taken.begin(), taken.end(), by_u);
        std::sort(expected.begin(), expected.end(), by_u);
        for (std::size_t i = 0; i < taken.size(); ++i) {  // to some roundings, in double and single precision
          BOOST_TEST(std::abs(taken[i].u_lambda - expected[i].u_lambda) <= 1e-12 * std::abs(expected[i].u_lambda));
          BOOST_TEST(std::abs(taken[i].v_lambda - expected[i].v_lambda) <= 1e-12 * std::abs(expected[i].v_lambda));
          BOOST_TEST(std::abs(taken[i].one - expected[i].one) < 1e-6);
          BOOST_TEST(std::abs(taken[i].other - expected[i].other) < 1e-6);
          BOOST_TEST(std::abs(taken[i].weight - expected[i].weight) < 1e-6 * expected[i].weight);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(planes_have_the_same_bits_however_they_are_gathered) {
  const StoredVisibilities source = two_blocks();
  for (const auto how : {SpectralInterpolation::nearest, SpectralInterpolation::linear}) {
    const CubeSampling sampling = cube(how, 1.7e6);
    const GatheredPlanes all = gathered(source, sampling, {0, 6}, 1);
    const GatheredPlanes again = gathered(source, sampling, {0, 6}, 3);
    for (int plane = 0; plane < 6; ++plane) {
      BOOST_TEST(same_bits(all.plane(plane), again.plane(plane)));
      const GatheredPlanes alone = gathered(source, sampling, {plane, 1}, 2);
      BOOST_TEST(same_bits(all.plane(plane), alone.plane(0)));
      const PlaneView view(source, sampling, plane);
      StoredVisibilities viewed;
      const auto stream = view.open();
      while (auto block = stream->next()) viewed.append(std::move(block));
      BOOST_TEST(same_bits(all.plane(plane), viewed));
    }
  }
}

BOOST_AUTO_TEST_CASE(rows_without_a_usable_sample_are_left_out) {
  VisibilityBlock block = block_of(4);
  std::fill(block.weight.begin(), block.weight.end(), 0.0F);
  for (int plane = 0; plane < 6; ++plane) {
    PlaneGatherer gatherer(cube(SpectralInterpolation::linear), {0, 6}, 1);
    gatherer.add(block);
    BOOST_TEST(blocks_of(gatherer, plane).empty());
  }
}

BOOST_AUTO_TEST_CASE(samples_in_no_plane_are_counted_once_by_the_ranges_together) {
  VisibilityBlock block = block_of(5);
  block.frame_ratio.assign(rows, 1);
  const CubeSampling three{{first_hz + 2e6, channel_hz, 3, "TOPOCENT", 0}, SpectralInterpolation::linear};
  std::uint64_t below = 0, above = 0;
  for (std::size_t i = 0; i < block.samples(); ++i) {
    below += block.weight[i] != 0 && i % channels < 2;
    above += block.weight[i] != 0 && i % channels > 4;
  }
  const auto counted = [&](const PlaneRange& range) {
    PlaneGatherer gatherer(three, range, 1);
    gatherer.add(block);
    return gatherer.outside_planes();
  };
  BOOST_TEST(counted({0, 3}) == below + above);
  BOOST_TEST(counted({0, 1}) == below);
  BOOST_TEST(counted({1, 1}) == 0U);
  BOOST_TEST(counted({2, 1}) == above);
}

BOOST_AUTO_TEST_CASE(rows_keep_their_sights) {
  std::vector<VisibilityBlock> blocks{block_of(7), block_of(8)};
  for (VisibilityBlock& block : blocks)
    for (std::size_t row = 0; row < rows; ++row)
      block.sights.push_back(
          {static_cast<int>(row), 0, 0, static_cast<float>(std::atan2(block.uvw_m[3 * row + 1], block.uvw_m[3 * row]))});
  PlaneGatherer gatherer(cube(SpectralInterpolation::nearest), {0, 6}, 2),
      without(cube(SpectralInterpolation::nearest), {0, 6}, 2);
  for (VisibilityBlock& block : blocks) {
    gatherer.add(block);
    block.sights.clear();
    without.add(block);
  }
  const auto some = gatherer.take(true);
  for (int plane = 0; plane < 6; ++plane)
    for (const auto& gathered : some)
      for (const auto& block : gathered->blocks(plane)) {
        BOOST_TEST_REQUIRE(block->sights.size() == block->rows());
        for (std::size_t row = 0; row < block->rows(); ++row) {  // UVW is scaled, by the same in u and v
          const double angle = std::atan2(block->uvw_m[3 * row + 1], block->uvw_m[3 * row]);
          BOOST_TEST(std::abs(angle - block->sights[row].zenith_rad) < 1e-6);  // single precision
        }
      }
  for (const auto& block : blocks_of(without, 2)) BOOST_TEST(block->sights.empty());
}

BOOST_AUTO_TEST_CASE(blocks_must_tell_the_widths_of_channels) {
  VisibilityBlock block = block_of(6);
  block.channel_width_hz.clear();
  PlaneGatherer gatherer(cube(SpectralInterpolation::linear), {0, 6}, 1);
  BOOST_CHECK_THROW(gatherer.add(block), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
