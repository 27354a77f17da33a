#include "imager/beams/radial_function.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <mutex>
#include <set>

BOOST_AUTO_TEST_SUITE(radial_function)

using namespace misfit::imager;

BOOST_AUTO_TEST_CASE(a_level_is_found_where_the_function_first_falls_to_it) {
  const auto wave = [](double sine) { return std::cos(40 * sine); };
  for (const double level : {0.9, 0.5, 0.0, -0.9})
    BOOST_TEST(std::abs(first_sine_at(level, 0.01, wave) - std::acos(level) / 40) < 1e-12);
  BOOST_TEST(first_sine_at(-1.5, 0.01, wave) == 1.0);
  BOOST_TEST(std::abs(first_sine_at(0.5, 0.3, [](double sine) { return 1 - sine; }) - 0.5) < 1e-15);
}

BOOST_AUTO_TEST_CASE(tables_are_their_functions_up_to_their_reach) {
  const auto lobe = [](double sine) { return std::exp(-3 * sine * sine) * std::cos(2 * sine); };
  const RadialTable table(0.8, 2, lobe);
  for (int i = 0; i <= 1000; ++i) BOOST_TEST(std::abs(table(0.0008 * i) - lobe(0.0008 * i)) < 1e-10);
}

BOOST_AUTO_TEST_CASE(tables_of_several_functions_are_these_as_finely_as_they_are_asked_to_be) {
  const auto function = [](double sine, std::size_t k) {
    return std::exp(-3 * sine * sine) * std::cos(60 * static_cast<double>(k) * sine * sine);
  };
  const auto worst = [&](double detail) {
    const RadialTables table(
        0.8, 2, 3,
        [&](double sine, double* values) {
          for (std::size_t k = 0; k < 3; ++k) values[k] = function(sine, k);
        },
        detail);
    double most = 0;
    for (int i = 0; i <= 1000; ++i) {
      double values[2];
      table.write(0.0008 * i, 1, 2, values);
      for (std::size_t k = 0; k < 2; ++k) most = std::max(most, std::abs(values[k] - function(0.0008 * i, 1 + k)));
    }
    return most;
  };
  BOOST_TEST(worst(20) < 1e-8);
  BOOST_TEST(worst(1) > 1e-6);
}

/// By the angle between unit vectors.
BOOST_AUTO_TEST_CASE(pixels_are_visited_once_where_their_true_angle_is_within_reach) {
  const ImageGeometry geometry{50, 40, 0.03, {}};  // beyond the horizon in its corners
  const DirectionCosines axis{0.5, -0.3};
  const auto n = [](DirectionCosines at) { return std::sqrt(1 - at.l * at.l - at.m * at.m); };
  for (const double reach : {0.1, 0.7, 1.0}) {
    std::mutex mutex;
    std::set<std::size_t> visited;
    for_each_within(reach, axis, geometry, 2, [&](std::size_t pixel, double sine) {
      const std::lock_guard lock(mutex);
      BOOST_TEST(visited.insert(pixel).second);
      const DirectionCosines at = geometry.at(int(pixel) / 50, int(pixel) % 50);
      const double cosine = at.l * axis.l + at.m * axis.m + n(at) * n(axis);
      BOOST_TEST(std::abs(sine * sine + cosine * cosine - 1) < 1e-12);
    });
    for (std::size_t pixel = 0; pixel < geometry.pixels(); ++pixel) {
      const DirectionCosines at = geometry.at(int(pixel) / 50, int(pixel) % 50);
      const double cosine = beyond_horizon(at) ? -1 : at.l * axis.l + at.m * axis.m + n(at) * n(axis);
      const bool within = cosine > 1e-9 && std::sqrt(1 - cosine * cosine) < reach - 1e-9;
      if (within) BOOST_TEST(visited.count(pixel) == 1U);
      if (cosine < -1e-9) BOOST_TEST(visited.count(pixel) == 0U);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
