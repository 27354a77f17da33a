#include "imager/beams/image_pattern.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <stdexcept>

#include "imager/beams/primary_beam.h"
#include "imager/numerics/constants.h"

BOOST_AUTO_TEST_SUITE(image_pattern)

using namespace misfit::imager;

namespace {

constexpr double hz = 1.4e9, arcmin = pi / 180 / 60;
constexpr double east_width = 30 * arcmin, north_width = 42 * arcmin;

/// The voltage of an elliptical Gaussian beam, by angles to the east and to the north where the zenith is north.
double ellipse(double east_rad, double north_rad) {
  const double x = east_rad / east_width, y = north_rad / north_width;
  return std::exp2(-2 * (x * x + y * y));
}

/// It, on pixels of an arcminute, of which columns run to the west and the axis is beside the middle.
PatternGrid grid_of(std::vector<double> frequencies_hz = {hz}) {
  PatternGrid grid{101, 121, 48, 61, -arcmin, arcmin, false, {}};
  for (const double at : frequencies_hz) {
    grid.planes.push_back({at, {}});
    for (int r = 0; r < grid.height; ++r)
      for (int c = 0; c < grid.width; ++c)
        grid.planes.back().voltage.push_back(
            ellipse((c - grid.axis_column) * grid.column_rad * at / hz, (r - grid.axis_row) * grid.row_rad * at / hz));
  }
  return grid;
}

}  // namespace

BOOST_AUTO_TEST_CASE(between_pixels_and_at_other_frequencies_it_is_the_function_that_pixels_hold) {
  const Pattern one = misfit::imager::image_pattern(grid_of()),
                cube = misfit::imager::image_pattern(grid_of({1e9, 1.4e9, 2e9}));
  BOOST_TEST(!one->is_round());
  for (const Pattern& pattern : {one, cube})
    for (const double at : {0.9e9, 1.2e9, 1.4e9, 2.5e9})
      for (double away = 0; away < 25 * arcmin; away += 1.7 * arcmin)
        for (double angle = 0; angle < 6; angle += 0.7) {
          const double expected = ellipse(away * std::sin(angle) * at / hz, away * std::cos(angle) * at / hz);
          // The fourth difference of a Gaussian, 2 % of a width a pixel: 3e-5.
          BOOST_TEST(std::abs(pattern->voltage_at(std::sin(away), angle, at) - expected) < 1e-4);
        }
  BOOST_TEST(one->voltage_at(std::sin(60 * arcmin), 1, hz) == 0.0);
  BOOST_TEST(std::abs(std::asin(one->main_lobe_sine(hz)) - 48 * arcmin) < 1e-9);  // to the nearest rim
}

BOOST_AUTO_TEST_CASE(what_is_no_grid_is_refused) {
  const auto changed = [](const auto& change) {
    PatternGrid grid = grid_of();
    change(grid);
    return grid;
  };
  for (const PatternGrid& wrong :
       {changed([](PatternGrid& g) { g.planes.clear(); }), changed([](PatternGrid& g) { g.axis_row = 300; }),
        changed([](PatternGrid& g) { g.planes[0].frequency_hz = 0; }), changed([](PatternGrid& g) { g.width = 100; })})
    BOOST_CHECK_THROW(misfit::imager::image_pattern(wrong), std::invalid_argument);
}

/// Turned by each of some angles with some weight, at some frequencies.
BOOST_AUTO_TEST_CASE(a_beam_is_the_mean_of_its_patterns_as_they_are_turned) {
  const Pattern pattern = misfit::imager::image_pattern(grid_of());
  std::vector<BeamShare> shares;
  for (int i = 0; i < 40; ++i)
    shares.push_back({pattern, pattern, hz * (1 + 0.004 * i), 1 + 0.3 * std::sin(i), -0.9 + 0.04 * i});
  const PrimaryBeam beam(shares);
  BOOST_TEST(!beam.is_round());
  const ImageGeometry geometry{81, 81, arcmin, {1, 0.5, "FK5"}};
  const Image image = primary_beam_image(beam, geometry, {{}, 0.2, 2});
  int seen = 0;
  for (int row = 0; row < 81; row += 3)
    for (int column = 0; column < 81; column += 3) {
      const double l = geometry.l(column), m = geometry.m(row);
      double sum = 0, weight = 0;
      for (const BeamShare& s : shares) {
        const double away = std::asin(std::hypot(l, m)) * s.frequency_hz / hz, angle = std::atan2(l, m) - s.turn_rad;
        sum += s.weight * std::pow(ellipse(away * std::sin(angle), away * std::cos(angle)), 2);
        weight += s.weight;
      }
      const double expected = sum / weight;
      if (std::abs(expected - 0.2) < 1e-3) continue;
      BOOST_TEST(std::isnan(image.at(row, column)) == (expected < 0.2));
      if (expected < 0.2) continue;
      ++seen;
      BOOST_TEST(std::abs(image.at(row, column) - expected) < 2e-4);
    }
  BOOST_TEST(seen > 100);
}

/// Where the axis is beside the phase centre, north is where the pole is there.
BOOST_AUTO_TEST_CASE(far_from_the_phase_centre_it_is_upright_at_its_axis) {
  const Pattern pattern = misfit::imager::image_pattern(grid_of());
  const PrimaryBeam beam({{pattern, pattern, hz, 1, 0.3}});
  const SkyDirection axis{1.2, 1.2, "FK5"};
  const ImageGeometry at_axis{41, 41, 2 * arcmin, axis};
  ImageGeometry away{301, 301, 2 * arcmin, {1.5, 1.2, "FK5"}};
  const DirectionCosines there = direction_cosines(axis, away.phase_centre);
  away.centre = there;
  const Image near = primary_beam_image(beam, at_axis, {{}, 0.2, 1}), far = primary_beam_image(beam, away, {there, 0.2, 1});
  int compared = 0;
  for (int row = 0; row < away.height; ++row)
    for (int column = 0; column < away.width; ++column) {
      if (std::isnan(far.at(row, column))) continue;
      const DirectionCosines at = direction_cosines(sky_direction(away.at(row, column), away.phase_centre), axis);
      const double expected = [&] {
        const double theta = std::asin(std::hypot(at.l, at.m)), angle = std::atan2(at.l, at.m) - 0.3;
        return std::pow(ellipse(theta * std::sin(angle), theta * std::cos(angle)), 2);
      }();
      BOOST_TEST(std::abs(far.at(row, column) - expected) < 2e-4);
      ++compared;
    }
  BOOST_TEST(compared > 100);
  BOOST_TEST(std::abs(near.at(20, 20) - 1) < 1e-4);
}

BOOST_AUTO_TEST_SUITE_END()
