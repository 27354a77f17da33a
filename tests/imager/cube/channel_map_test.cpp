#include "imager/cube/channel_map.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numeric>

BOOST_AUTO_TEST_SUITE(channel_map)

using namespace misfit::imager;

namespace {

struct Window {
  std::vector<double> frequency_hz, width_hz;

  Window(double first_hz, double step_hz, std::size_t count) : width_hz(count, std::abs(step_hz)) {
    for (std::size_t c = 0; c < count; ++c) frequency_hz.push_back(first_hz + step_hz * static_cast<double>(c));
  }
  Channels channels() const { return {frequency_hz, width_hz}; }
};

CubeSampling sampling(double first_hz, double step_hz, int count, SpectralInterpolation how) {
  return {{first_hz, step_hz, count, "LSRK", 0}, how};
}

ChannelMap map_of(const CubeSampling& cube, const Window& window, double ratio = 1) {
  return map_channels(cube, {0, cube.axis.channels}, window.channels(), ratio);
}

/// What a plane's sample would hold of visibilities that are linear in the data's frequency.
double frequency_of(const ChannelTap& tap, const Window& window) {
  return (1 - tap.part) * window.frequency_hz[tap.channel] + tap.part * window.frequency_hz[tap.other];
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_channel_belongs_to_the_one_plane_that_holds_its_middle) {
  for (const double step : {1e6, -1e6})
    for (const double width : {0.9e6, 1e6, 2.5e6, 4e6, -1e6, -3.3e6})
      for (const double ratio : {1.0, 1.0001, 0.9997}) {
        BOOST_TEST_CONTEXT("channels of " << step << ", planes of " << width << ", ratio " << ratio) {
          const Window window(1.4e9 + (step > 0 ? 0 : 31e6), step, 32);
          const double first = width > 0 ? 1.398e9 : 1.433e9;
          const CubeSampling cube =
              sampling(first, width, static_cast<int>(40e6 / std::abs(width)), SpectralInterpolation::nearest);
          const ChannelMap map = map_of(cube, window, ratio);
          BOOST_TEST(map.uvw_scale == 1);
          std::vector<int> taken(32);
          for (int plane = 0; plane < cube.axis.channels; ++plane) {
            const PlaneChannels& of = map.planes[static_cast<std::size_t>(plane)];
            BOOST_TEST_REQUIRE(of.tap.size() == of.frequency_hz.size());
            for (std::size_t i = 0; i < of.tap.size(); ++i) {
              BOOST_TEST(of.tap[i].part == 0);
              BOOST_TEST(of.frequency_hz[i] == window.frequency_hz[of.tap[i].channel]);
              const double at = cube.axis.plane_of(of.frequency_hz[i] * ratio) - plane;
              if (std::abs(at) <= 0.5 + 1e-9) {
                ++taken[of.tap[i].channel];
              } else {  // it covers the middle of a plane that holds no other
                BOOST_TEST((of.tap.size() == 1 && std::abs(at) * std::abs(width) <= 0.5 * std::abs(step) * ratio * (1 + 1e-5)));
              }
            }
          }
          BOOST_TEST(taken == std::vector<int>(32, 1), boost::test_tools::per_element());
        }
      }
}

BOOST_AUTO_TEST_CASE(interpolation_is_at_the_planes_own_frequency) {
  for (const double step : {1e6, -1e6})
    for (const double ratio : {1.0, 1.00013, 0.99991}) {
      BOOST_TEST_CONTEXT("channels of " << step << ", ratio " << ratio) {
        const Window window(1.4e9 + (step > 0 ? 0 : 31e6), step, 32);
        const CubeSampling cube = sampling(1.4053e9, 0.8e6, 20, SpectralInterpolation::linear);
        const ChannelMap map = map_of(cube, window, ratio);
        BOOST_TEST(map.uvw_scale == 1 / ratio);
        for (int plane = 0; plane < 20; ++plane) {
          const PlaneChannels& of = map.planes[static_cast<std::size_t>(plane)];
          BOOST_TEST_REQUIRE(of.tap.size() == 1U);
          BOOST_TEST(of.frequency_hz.front() == cube.axis.frequency_hz(plane));
          // 1e-6 of a channel, where one alone is taken.
          BOOST_TEST(std::abs(frequency_of(of.tap.front(), window) * ratio - of.frequency_hz.front()) < 1.1);
        }
      }
    }
}

BOOST_AUTO_TEST_CASE(planes_that_lie_on_channels_take_these_alone) {
  const Window window(1.4e9, 1e6, 8);
  const ChannelMap map = map_of(sampling(1.4e9, 1e6, 8, SpectralInterpolation::linear), window);
  for (std::size_t plane = 0; plane < 8; ++plane) {
    BOOST_TEST_REQUIRE(map.planes[plane].tap.size() == 1U);
    BOOST_TEST(map.planes[plane].tap[0].channel == plane);
    BOOST_TEST(map.planes[plane].tap[0].part == 0);
  }
}

BOOST_AUTO_TEST_CASE(wide_planes_take_as_many_places_as_channels_fit) {
  const Window window(1.4e9, 1e6, 32);
  for (const double channels_a_plane : {1.4, 1.6, 2.0, 4.0, 7.7}) {
    BOOST_TEST_CONTEXT(channels_a_plane << " channels a plane") {
      const double width = channels_a_plane * 1e6;
      const CubeSampling cube = sampling(1.4e9 + 0.5 * (width - 1e6), width, 3, SpectralInterpolation::linear);
      for (const PlaneChannels& of : map_of(cube, window).planes)
        BOOST_TEST(of.tap.size() == static_cast<std::size_t>(std::lround(channels_a_plane)));
    }
  }
}

BOOST_AUTO_TEST_CASE(nothing_is_interpolated_across_missing_channels) {
  Window window(1.4e9, 1e6, 4);
  window.frequency_hz = {1.4e9, 1.401e9, 1.404e9, 1.405e9};
  for (const double hz : {1.4018e9, 1.4025e9, 1.4032e9})
    BOOST_TEST(map_of(sampling(hz, 1e5, 1, SpectralInterpolation::linear), window).planes[0].tap.empty());
  const ChannelMap beside = map_of(sampling(1.4014e9, 1e5, 1, SpectralInterpolation::linear), window);
  BOOST_TEST_REQUIRE(beside.planes[0].tap.size() == 1U);
  BOOST_TEST(beside.planes[0].tap[0].channel == 1U);
  BOOST_TEST(beside.planes[0].tap[0].part == 0);
}

BOOST_AUTO_TEST_CASE(data_reach_half_a_channel_beyond_the_last) {
  const Window window(1.4e9, 1e6, 4);
  for (const auto how : {SpectralInterpolation::nearest, SpectralInterpolation::linear})
    for (const auto& [hz, taken] : {std::pair{1.39949e9, 0U}, {1.39951e9, 1U}, {1.40349e9, 1U}, {1.40351e9, 0U}})
      BOOST_TEST(map_of(sampling(hz, 1e3, 1, how), window).planes[0].tap.size() == taken);
}

BOOST_AUTO_TEST_CASE(one_channel_alone_is_taken_where_it_covers_the_plane) {
  const Window window(1.4e9, 4e6, 1);
  for (const auto how : {SpectralInterpolation::nearest, SpectralInterpolation::linear}) {
    const ChannelMap map = map_of(sampling(1.396e9, 1e6, 9, how), window);
    for (int plane = 0; plane < 9; ++plane)
      BOOST_TEST(map.planes[static_cast<std::size_t>(plane)].tap.size() == (plane >= 2 && plane <= 6 ? 1U : 0U));
  }
}

BOOST_AUTO_TEST_CASE(a_plane_far_wider_than_the_data_takes_what_there_is_at_once) {
  const std::vector<double> frequency_hz{1e9, 1.001e9, 1.002e9}, width_hz(3, 1e6);
  for (const double increment_hz : {1e16, -1e16, 1e6}) {
    const CubeSampling sampling{{1.0012e9, increment_hz, 1, "TOPO", 0}, SpectralInterpolation::linear};
    const ChannelMap map = map_channels(sampling, {0, 1}, {frequency_hz, width_hz}, 1);
    const double taken = static_cast<double>(map.planes.front().tap.size());
    BOOST_TEST(taken == (increment_hz == 1e6 ? 1 : 3));
  }
}

BOOST_AUTO_TEST_CASE(planes_evenly_spaced_in_wavelength_share_all_channels) {
  const Window window(1.2e9, 1e6, 400);
  for (const double step : {2e6, -2e6, 5.3e6, -0.7e6}) {
    const double first = step > 0 ? 1.2e9 : 1.6e9;
    const int planes = static_cast<int>(std::ceil((1 - first / (step > 0 ? 1.65e9 : 1.15e9)) * first / step));
    const SpectralAxis axis{first, step, planes, "LSRK", 1.4e9, true};
    for (int plane = 1; plane < planes; ++plane)
      BOOST_TEST(std::abs(1 / axis.frequency_hz(plane) - 1 / axis.frequency_hz(plane - 1) + step / (first * first)) <
                 1e-13 / first);
    std::vector<int> taken(400);
    for (const auto& plane : map_of({axis, SpectralInterpolation::nearest}, window).planes)
      for (const ChannelTap& tap : plane.tap) ++taken[tap.channel];
    const auto planes_of = map_of({axis, SpectralInterpolation::linear}, window).planes;
    for (std::size_t c = 3; c + 3 < 400; ++c)
      BOOST_TEST((std::abs(step) < 1.7e6 ? taken[c] >= 1 : taken[c] == 1), "channel " << c << " of planes by " << step);
    for (int plane = 0; plane < planes; ++plane) {
      const PlaneChannels& of = planes_of[static_cast<std::size_t>(plane)];
      const FrequencyBand band = axis.planes(plane, 1);
      for (std::size_t i = 0; i < of.tap.size(); ++i) {
        BOOST_TEST(std::abs(frequency_of(of.tap[i], window) - of.frequency_hz[i]) <
                   1e-6 * 1e6 + 0.51e6 * (of.tap[i].part == 0));
        BOOST_TEST((of.frequency_hz[i] > band.low_hz && of.frequency_hz[i] < band.high_hz));
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
