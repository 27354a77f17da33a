#include "imager/weighting/uv_window.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "imager/weighting/imaging_weights.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(uv_window)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double cell_rad = 1e-5;  // the grid ends at 50 kλ
const ImageGeometry geometry{64, 48, cell_rad, {}};
constexpr float least = std::numeric_limits<float>::min();

std::vector<float> weights_by(const VisibilityBlock& block, const WeightingOptions& options) {
  StoredVisibilities source = stored({block});
  make_imaging_weights(source, options, geometry, {1})->put_on(source, 1);
  return source.blocks().front()->weight;
}

/// The window's factor as the documentation words it: samples beyond the limits are left out, and a transition is half a period
/// of a cosine.
double plain_factor(double r, double min, double max, double inner, double outer) {
  if (r > max || r < min) return 0;
  double factor = 1;
  if (max - r < outer) factor *= (1 - std::cos(M_PI * (max - r) / outer)) / 2;
  if (r - min < inner) factor *= (1 - std::cos(M_PI * (r - min) / inner)) / 2;
  return factor;
}

}  // namespace

BOOST_AUTO_TEST_CASE(nothing_is_asked_of_a_whole_plane) {
  BOOST_TEST(UvWindow().is_whole_plane());
  BOOST_TEST(UvWindow().factor(0) == 1);
  BOOST_TEST(UvWindow().factor(1e12) == 1);
  BOOST_TEST(WeightingOptions().none());
  BOOST_TEST(!WeightingOptions{.window = {.max_lambda = 1e4}}.none());
  BOOST_TEST(!WeightingOptions{.window = {.inner_edge_lambda = 1e3}}.none());
}

BOOST_AUTO_TEST_CASE(limits_belong_to_the_window_and_edges_begin_there_at_zero) {
  const UvWindow steep{1000, 3000}, smooth{1000, 3000, 400, 500};
  for (const double r : {999.999, 3000.001}) BOOST_TEST(steep.factor(r) == 0);
  for (const double r : {1000., 2000., 3000.}) BOOST_TEST(steep.factor(r) == 1);
  for (const double r : {999., 1000., 3000., 3001.}) BOOST_TEST(smooth.factor(r) == 0);
  for (const double r : {1400., 2000., 2500.}) BOOST_TEST(smooth.factor(r) == 1);
  for (const double r : {1200., 2750.}) BOOST_TEST(std::abs(smooth.factor(r) - 0.5) < 1e-15);
}

BOOST_DATA_TEST_CASE(weights_are_their_formula_at_each_channels_own_wavelengths,
                     bdata::make({0., 8e3, 20e3}) * bdata::make({25e3, 45e3, 1e9}) * bdata::make({0., 3e3, 30e3}) *
                         bdata::make({0., 4e3, 40e3}),
                     min, max, inner, outer) {
  if (min == 0 && max == 1e9 && inner == 0) return;
  const VisibilityBlock block = random_samples(80, 3, cell_rad, 7, 1.2);
  const WeightingOptions options{.taper = taper_of_radii({30e3, 30e3, 0}), .window = {min, max, inner, outer}};
  const std::vector<float> made = weights_by(block, options);
  bool outside = false, inside = false;
  for (std::size_t row = 0; row < block.rows(); ++row)
    for (std::size_t c = 0; c < block.channels(); ++c) {
      const double per_m = block.frequency_hz[c] / speed_of_light_m_s;
      const double u = block.uvw_m[3 * row] * per_m, v = block.uvw_m[3 * row + 1] * per_m, r = std::sqrt(u * u + v * v);
      const bool in_grid = std::abs(u) <= 50e3 && std::abs(v) <= 50e3;
      const double factor = in_grid ? plain_factor(r, min, max, inner, outer) : 0;
      const std::size_t i = row * block.channels() + c;
      (factor == 0 ? outside : inside) = true;
      // A rounding to single precision, and that of r, which matters where the factor is nearly 0.
      const double expected = double{block.weight[i]} * factor * std::exp2(-r * r / (30e3 * 30e3));
      if (factor == 0)
        BOOST_TEST(made[i] == least);
      else
        BOOST_TEST(std::abs(double{made[i]} - expected) < 1e-7 * expected + 1e-13);
    }
  BOOST_TEST(inside);
  BOOST_TEST(outside);
}

BOOST_AUTO_TEST_CASE(the_density_counts_samples_outside_the_window_too) {
  const VisibilityBlock block = random_samples(300, 2, cell_rad, 8);
  const WeightingOptions all{.weighting = Weighting::briggs, .robust = 0};
  WeightingOptions part = all;
  part.window.max_lambda = 30e3;
  const std::vector<float> of_all = weights_by(block, all), of_part = weights_by(block, part);
  for (std::size_t i = 0; i < of_all.size(); ++i) BOOST_TEST((of_part[i] == of_all[i] || of_part[i] == least));
  BOOST_CHECK(of_part != of_all);
}

BOOST_AUTO_TEST_CASE(sums_tell_of_a_window_that_no_sample_lies_in) {
  const VisibilityBlock block = random_samples(300, 2, cell_rad, 9);
  const auto sums = [&](const UvWindow& window) {
    StoredVisibilities source = stored({block});
    return make_imaging_weights(source, {.window = window}, geometry, {1})->put_on(source, 1).sums;
  };
  BOOST_TEST(!sums({.max_lambda = 1e-3}).outweigh_least(block.samples()));
  BOOST_TEST(sums({.max_lambda = 1e-3}).image == 0);
  BOOST_TEST(sums({.max_lambda = 30e3}).outweigh_least(block.samples()));
  // Samples that are left out cost noise, so they count among those of natural weights.
  BOOST_TEST(sums({.max_lambda = 30e3}).natural == sums({.max_lambda = 1e9}).natural);
  BOOST_TEST(sums({.max_lambda = 30e3}).noise_jy() > sums({.max_lambda = 30e3}).natural_noise_jy());
}

BOOST_AUTO_TEST_SUITE_END()
