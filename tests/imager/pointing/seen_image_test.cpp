#include "imager/pointing/seen_image.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "imager/beams/airy_pattern.h"
#include "imager/beams/image_pattern.h"
#include "imager/beams/telescopes.h"
#include "imager/direct/direct_transform.h"
#include "imager/direct/source_sums.h"
#include "imager/numerics/constants.h"
#include "imager/pointing/seen_sources.h"
#include "tests/imager/comparison.h"
#include "tests/imager/vla_samples.h"

BOOST_AUTO_TEST_SUITE(seen_image)

using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double arcmin = pi / 180 / 60;

/// An elliptical Gaussian of 40′ by 56′ between half-power points at 1.4 GHz.
Pattern elliptical() {
  PatternGrid grid{121, 121, 60, 60, -1.2 * arcmin, 1.2 * arcmin, false, {{1.4e9, {}}}};
  for (int r = 0; r < grid.height; ++r)
    for (int c = 0; c < grid.width; ++c) {
      const double x = (c - grid.axis_column) * 1.2 / 40, y = (r - grid.axis_row) * 1.2 / 56;
      grid.planes.front().voltage.push_back(std::exp2(-2 * (x * x + y * y)));
    }
  return misfit::imager::image_pattern(grid);
}

/// Three sorts of dishes, and two pointings beside the phase centre.
struct Scene {
  ImageGeometry geometry{48, 40, 1.5 * arcmin, {1, 0.6}, {0.001, -0.002}};
  RowBeams beams{{airy_pattern({25, 2}), airy_pattern({13.5, 0}), elliptical()},
                 {AxisFrame({0.004, 0.003}, 0.6), AxisFrame({-0.006, 0}, 0.6)}};
  SampleCoordinates at;

  Scene() {
    const VisibilityBlock vla = vla_samples(1, 600);
    at.uvw_m = std::vector<double>(vla.uvw_m.begin(), vla.uvw_m.begin() + 3 * 60);
    for (std::size_t r = 0; r < at.rows(); ++r) {
      at.uvw_m.edit()[3 * r + 2] = 10.0 * static_cast<double>(r % 7);
      const int row = static_cast<int>(r);
      at.sights.push_back({row % 3, (row / 3) % 3, row % 2, 0.5F * static_cast<float>(row / 20)});
    }
    for (int c = 0; c < 12; ++c) at.frequency_hz.push_back(1.2e9 + 50e6 * c);  // to 1.45 times the first
  }
};

/// One of the rows, with its sight.
SampleCoordinates row_with_sight(const SampleCoordinates& at, std::size_t row) {
  SampleCoordinates one = rows_of(at, {row});
  one.sights = {at.sights[row]};
  return one;
}

/// The pixels as points.
std::vector<Source> points_of(const Image& image, const ImageGeometry& geometry) {
  std::vector<Source> points;
  for (int r = 0; r < image.height; ++r)
    for (int c = 0; c < image.width; ++c)
      if (image.at(r, c) != 0) points.push_back({geometry.at(r, c), image.at(r, c)});
  return points;
}

}  // namespace

BOOST_AUTO_TEST_CASE(sources_are_seen_row_by_row_and_channel_by_channel) {
  const Scene scene;
  const std::vector<Source> sources{{{0.002, 0.001}, 2}, {{-0.005, 0.004}, 1, 3 * arcmin}};
  const auto seen = predict_seen_sources(sources, scene.beams, scene.at, 2);
  for (std::size_t r = 0; r < scene.at.rows(); ++r)
    for (std::size_t c = 0; c < scene.at.channels(); ++c) {
      const RowBeams::Group group = scene.beams.groups(row_with_sight(scene.at, r)).front();
      SampleCoordinates one = rows_of(scene.at, {r});
      one.frequency_hz = {scene.at.frequency_hz[c]};
      std::complex<double> expected = 0;
      for (const Source& source : sources)
        expected += group.beam.power(source.position, one.frequency_hz.front()) * predict_sources({source}, one, 1).front();
      BOOST_TEST(std::abs(seen[r * scene.at.channels() + c] - expected) < 1e-13);
    }
}

/// With the definition as the transform, whose own error is that of rounding, what is left is that of beams between nodes.
BOOST_AUTO_TEST_CASE(an_image_is_seen_as_its_pixels_are) {
  const Scene scene;
  Image model(scene.geometry.width, scene.geometry.height);
  for (int k = 0; k < 40; ++k) model.at((7 * k) % 40, (11 * k + k / 40) % 48) = 1 + 0.1 * k;
  const DirectTransform transform(scene.geometry, 2);
  const auto expected = predict_seen_sources(points_of(model, scene.geometry), scene.beams, scene.at, 2);
  double flux_jy = 0;
  for (const double value : model.pixel) flux_jy += std::abs(value);
  for (const auto& [tolerance, kept_bytes] : {std::pair(1e-4, std::size_t{1} << 30), {1e-8, std::size_t{0}}}) {
    SeenImage seen(transform, model, scene.geometry, scene.beams, scene.at.frequency_hz, {tolerance, kept_bytes, 2});
    const auto found = seen.at(scene.at);
    double largest = 0;
    for (std::size_t i = 0; i < found.size(); ++i) largest = std::max(largest, std::abs(found[i] - expected[i]));
    // Voltages to the tolerance each, products of two that differ, and turns by four times that.
    BOOST_TEST(largest < 7 * tolerance * flux_jy);
    BOOST_TEST((seen.at(scene.at) == found));
  }
}

BOOST_AUTO_TEST_CASE(a_dense_model_is_multiplied_by_a_table_of_a_round_beam) {
  ImageGeometry geometry{200, 160, 0.2 * arcmin, {1, 0.6}, {}};
  const Image model = random_image(geometry.width, geometry.height, 3);
  const PairBeam beam{airy_pattern({25, 2}), airy_pattern({13.5, 0}), AxisFrame({0.002, -0.001}, 0.6), 0};
  const Image seen = seen_by(beam, model, geometry, 1.4e9, 2);
  for (int r = 0; r < geometry.height; r += 7)
    for (int c = 0; c < geometry.width; c += 5)
      BOOST_TEST(std::abs(seen.at(r, c) - model.at(r, c) * beam.power(geometry.at(r, c), 1.4e9)) < 1e-9);
}

/// Sidelobes pass over it, which no image about the axis would see.
BOOST_AUTO_TEST_CASE(a_small_image_far_from_the_axis_is_seen_through_sidelobes) {
  Scene scene;
  scene.geometry = {24, 24, 0.1 * arcmin, {1, 0.6}, {}};
  const RowBeams beams({airy_pattern({25, 2}), airy_pattern({25, 2}), airy_pattern({13.5, 0})},
                       {AxisFrame({0.017, 0.001}, 0.6), AxisFrame({0, -0.013}, 0.6)});
  Image model(24, 24);
  for (int k = 0; k < 24; ++k) model.at(k, (5 * k) % 24) = 1;
  const DirectTransform transform(scene.geometry, 2);
  SeenImage seen(transform, model, scene.geometry, beams, scene.at.frequency_hz, {1e-8, 1, 2});
  const auto expected = predict_seen_sources(points_of(model, scene.geometry), beams, scene.at, 2), found = seen.at(scene.at);
  double largest = 0;
  for (std::size_t i = 0; i < found.size(); ++i) largest = std::max(largest, std::abs(found[i] - expected[i]));
  BOOST_TEST(largest < 3e-8 * 24);
}

BOOST_AUTO_TEST_CASE(pixels_beyond_the_horizon_and_behind_the_dishes_are_not_seen) {
  const ImageGeometry geometry{256, 256, 0.0085, {1, 0.6}, {}};  // all of the sky, and more in its corners
  Image model(256, 256);
  for (int r = 0; r < 256; ++r)
    for (int c = 0; c < 256; ++c) model.at(r, c) = beyond_horizon(geometry.at(r, c)) ? std::nan("") : 1;
  const PairBeam beam{airy_pattern({2, 0}), airy_pattern({2, 0}), AxisFrame({0.5, 0}, 0.6), 0};
  const Image seen = seen_by(beam, model, geometry, 1e8, 2);
  bool as_expected = true;
  for (int r = 0; r < 256; r += 3)
    for (int c = 0; c < 256; c += 3) {
      const bool known = !std::isnan(model.at(r, c));
      as_expected = as_expected &&
                    (known ? std::abs(seen.at(r, c) - beam.power(geometry.at(r, c), 1e8)) < 1e-8 : std::isnan(seen.at(r, c)));
    }
  BOOST_TEST(as_expected);
}

BOOST_AUTO_TEST_CASE(coordinates_that_were_not_told_of_are_refused) {
  Scene scene;
  const Image model(scene.geometry.width, scene.geometry.height);
  const DirectTransform transform(scene.geometry, 1);
  SeenImage seen(transform, model, scene.geometry, scene.beams, scene.at.frequency_hz, {});
  SampleCoordinates other = scene.at;
  other.frequency_hz.back() = 3e9;
  BOOST_CHECK_THROW(seen.at(other), std::invalid_argument);
  other = scene.at;
  other.sights.pop_back();
  BOOST_CHECK_THROW(seen.at(other), std::invalid_argument);
}

/// Fits end in steps of 1 % and more, which pass over pixels from channel to channel.
BOOST_AUTO_TEST_CASE(beams_that_end_in_steps_are_seen_as_they_end) {
  Scene scene;
  scene.geometry.cell_rad = 2.5 * arcmin;
  scene.at.frequency_hz.clear();
  for (int c = 0; c < 40; ++c) scene.at.frequency_hz.push_back(1.2e9 + 5e6 * c);
  const DirectTransform transform(scene.geometry, 2);
  for (const char* name : {"vla", "gmrt"})
    for (const int away : {1, 3}) {  // in the second, no pixel shines where beams end
      const Pattern pattern = named_beam(name, {}).pattern;
      const RowBeams beams({pattern, pattern, pattern}, {AxisFrame({0.004, 0.003}, 0.6), AxisFrame({-0.006, 0}, 0.6)});
      Image model(scene.geometry.width, scene.geometry.height);
      for (int k = 0; k < 24; ++k) model.at(20 + (7 * k % 40 - 20) / away, 24 + (11 * k % 48 - 24) / away) = 1;
      SeenImage seen(transform, model, scene.geometry, beams, scene.at.frequency_hz, {1e-7, std::size_t{1} << 30, 2});
      const auto expected = predict_seen_sources(points_of(model, scene.geometry), beams, scene.at, 2),
                 found = seen.at(scene.at);
      double largest = 0;
      for (std::size_t i = 0; i < found.size(); ++i) largest = std::max(largest, std::abs(found[i] - expected[i]));
      BOOST_TEST(largest < 3e-7 * 24);
    }
}

BOOST_AUTO_TEST_SUITE_END()
