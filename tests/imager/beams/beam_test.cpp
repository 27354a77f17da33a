#include "imager/beams/beam.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <string>

BOOST_AUTO_TEST_SUITE(beam)

namespace {

using namespace misfit::imager;

constexpr double cell_rad = 1e-6;
constexpr double degree = M_PI / 180;

/// The beam's height at an offset from its peak.
double gaussian(const Beam& beam, double east_rad, double north_rad) {
  const double s = std::sin(beam.position_angle_rad), c = std::cos(beam.position_angle_rad);
  const double along = (s * east_rad + c * north_rad) / beam.major_rad;
  const double across = (c * east_rad - s * north_rad) / beam.minor_rad;
  return std::exp2(-4 * (along * along + across * across));
}

Image sampled(const Beam& beam, int width, int height) {
  Image image(width, height);
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) image.at(r, c) = gaussian(beam, (width / 2 - c) * cell_rad, (r - height / 2) * cell_rad);
  return image;
}

/// Turns a square image of odd size from north to east.
Image turned(const Image& image) {
  Image result(image.width, image.height);
  for (int r = 0; r < image.height; ++r)
    for (int c = 0; c < image.width; ++c) result.at(image.width - 1 - c, r) = image.at(r, c);
  return result;
}

double angle_between(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, M_PI));
}

Image components() {
  Image model(40, 30);
  model.at(0, 0) = 1.5;
  model.at(0, 39) = -0.25;
  model.at(29, 0) = 2;
  model.at(29, 39) = 0.125;
  model.at(13, 17) = 3;
  model.at(14, 17) = 1;
  return model;
}

/// The PSF of a tapered uv coverage, an oblique ellipse of points; `edge` is its longest baseline in turns per pixel.
Image tapered_psf(double edge, int size) {
  std::mt19937 random(1);
  const auto coordinate = [&] { return 2 * static_cast<double>(random()) / std::mt19937::max() - 1; };
  Image psf(size, size);
  double total = 0;
  for (int i = 0; i < 300; ++i) {
    const double along = coordinate(), across = coordinate(), square = along * along + across * across;
    if (square > 1) continue;
    const double u = edge * (0.7 * along - 0.35 * across), v = edge * (0.7 * along + 0.35 * across);
    const double weight = std::exp(-0.5 * square);
    total += weight;
    for (int r = 0; r < size; ++r)
      for (int c = 0; c < size; ++c) psf.at(r, c) += weight * std::cos(2 * M_PI * (u * (size / 2 - c) + v * (r - size / 2)));
  }
  for (double& pixel : psf.pixel) pixel /= total;
  return psf;
}

const Beam oblique{7.3 * cell_rad, 4.1 * cell_rad, 0.6};

}  // namespace

BOOST_AUTO_TEST_CASE(a_sampled_gaussian_is_recovered_from_either_region) {
  // The residual is zero at the solution, so only rounding and the stop of the iteration (1e-14) remain; 1e-6 is the promise.
  // A main lobe 6 pixels by 3.9 is interpolated as what has no u beyond the grid: at its edge the Gaussian is down to 1.3e-6.
  for (const BeamRegion region : {BeamRegion::main_lobe, BeamRegion::quadrant})
    for (const double major : {region == BeamRegion::quadrant ? 1.5 : 6.0, 8.0, 40.0})
      for (const double ratio : {1.0, 0.8, 0.65})
        for (const double angle_deg : {-75.0, -45.0, 0.0, 10.0, 45.0, 60.0, 90.0}) {
          const Beam expected{major * cell_rad, major * ratio * cell_rad, angle_deg * degree};
          const Beam fitted = fit_beam(sampled(expected, 201, 200), cell_rad, region);
          BOOST_TEST_INFO("major " << major << " ratio " << ratio << " angle " << angle_deg);
          BOOST_TEST(std::abs(fitted.major_rad / expected.major_rad - 1) < 1e-6);
          BOOST_TEST(std::abs(fitted.minor_rad / expected.minor_rad - 1) < 1e-6);
          BOOST_TEST((ratio == 1 || angle_between(fitted.position_angle_rad, expected.position_angle_rad) < 1e-6));
          BOOST_TEST((fitted.position_angle_rad > -M_PI_2 && fitted.position_angle_rad <= M_PI_2));
        }
}

BOOST_AUTO_TEST_CASE(the_angle_grows_from_north_towards_lower_columns) {
  Image psf(33, 33);
  for (int i = -6; i <= 6; ++i)
    for (int j = -3; j <= 3; ++j) psf.at(16 + i, 16 - i + j) = std::exp(-0.05 * i * i - 0.3 * j * j);
  // The ridge runs towards higher rows and lower columns: somewhere between north and east.
  const double angle_rad = fit_beam(psf, cell_rad).position_angle_rad;
  BOOST_TEST((angle_rad > 0.1 && angle_rad < M_PI_2));
}

BOOST_AUTO_TEST_CASE(turning_the_psf_by_a_right_angle_turns_the_beam) {
  // No Gaussian: the main lobe's fit must turn all the same. Where the residual is not 0, steps that lower the sum of squares
  // by less than its rounding are not taken: either fit stops within some √(2⁻⁵³) = 1e-8 of its minimum.
  Image psf = sampled(oblique, 65, 65);
  for (double& value : psf.pixel) value = std::pow(value, 1.4) * 0.7 + 0.3 * std::sqrt(value);
  const Beam before = fit_beam(psf, cell_rad);
  const Beam after = fit_beam(turned(psf), cell_rad);
  const double expected_rad = before.position_angle_rad + M_PI_2;
  BOOST_TEST(std::abs(after.major_rad / before.major_rad - 1) < 1e-7);
  BOOST_TEST(std::abs(after.minor_rad / before.minor_rad - 1) < 1e-7);
  BOOST_TEST(angle_between(after.position_angle_rad, expected_rad) < 1e-7);
}

BOOST_AUTO_TEST_CASE(the_quadrant_is_the_one_to_the_north_west) {
  Image psf = sampled(oblique, 65, 65);
  const Beam before = fit_beam(psf, cell_rad, BeamRegion::quadrant);
  for (int r = 0; r < 65; ++r)
    for (int c = 0; c < 65; ++c)
      if ((r < 32 || c < 32) && std::abs(r - 32) + std::abs(c - 32) > 12) psf.at(r, c) += 0.2;
  BOOST_TEST(fit_beam(psf, cell_rad, BeamRegion::quadrant).major_rad == before.major_rad);
}

BOOST_AUTO_TEST_CASE(where_the_quadrant_fits_no_bounded_gaussian_the_main_lobe_is_fitted) {
  Image psf(101, 101);
  for (int r = -50; r <= 50; ++r)
    for (int c = -50; c <= 50; ++c) psf.at(50 + r, 50 + c) = std::exp(-0.005 * (r * r + c * c) - 0.1 * std::abs(r * c));
  const Beam beam = fit_beam(psf, cell_rad, BeamRegion::quadrant), lobe = fit_beam(psf, cell_rad);
  BOOST_TEST(beam.major_rad == lobe.major_rad);
  BOOST_TEST(beam.minor_rad == lobe.minor_rad);
}

BOOST_AUTO_TEST_CASE(the_beam_is_proportional_to_the_cell) {
  const Image psf = sampled(oblique, 65, 65);
  // As exact as any sampled Gaussian is recovered, see above.
  BOOST_TEST(std::abs(fit_beam(psf, 3 * cell_rad).major_rad / oblique.major_rad - 3) < 1e-6);
}

BOOST_AUTO_TEST_CASE(one_uv_coverage_has_one_beam_however_coarse_the_cell) {
  // From 9 pixels a beam's minor axis, whose lobe is fitted at its pixels, to 1.2. The fit depends a little on where the PSF is
  // taken: a pixel more or less of 30 that lie above the cutoff changes an axis by up to 1/60, hardly ever by half of that; and
  // the angle by q/(1 − q²) = 2/3 of such a part, where q = 1/2 is the ratio of the axes.
  const Beam fine = fit_beam(tapered_psf(0.08, 64), 0.08);
  for (const double edge : {0.1, 0.12, 0.13, 0.14, 0.15, 0.16, 0.17, 0.18, 0.2, 0.25, 0.3, 0.4, 0.5, 0.55, 0.63}) {
    const Beam beam = fit_beam(tapered_psf(edge, 64), edge);
    BOOST_TEST_INFO("longest baseline " << edge << " turns a pixel");
    BOOST_TEST(std::abs(beam.major_rad / fine.major_rad - 1) < 0.01);
    BOOST_TEST(std::abs(beam.minor_rad / fine.minor_rad - 1) < 0.01);
    BOOST_TEST(angle_between(beam.position_angle_rad, fine.position_angle_rad) < 0.01);
  }
}

BOOST_AUTO_TEST_CASE(what_is_nan_outside_the_main_lobe_is_not_fitted) {
  Image psf = sampled(oblique, 65, 65);
  const Beam whole = fit_beam(psf, cell_rad);
  for (int r = 0; r < 65; ++r)
    for (int c = 0; c < 65; ++c)
      if (std::abs(r - 32) + std::abs(c - 32) > 12) psf.at(r, c) = std::numeric_limits<double>::quiet_NaN();
  const Beam holed = fit_beam(psf, cell_rad);
  BOOST_TEST(holed.major_rad == whole.major_rad);
  BOOST_TEST(holed.minor_rad == whole.minor_rad);
  BOOST_TEST(holed.position_angle_rad == whole.position_angle_rad);
  const Beam quadrant = fit_beam(psf, cell_rad, BeamRegion::quadrant);
  // What is left is a sampled Gaussian, recovered as above.
  BOOST_TEST(std::abs(quadrant.major_rad / oblique.major_rad - 1) < 1e-6);
}

BOOST_AUTO_TEST_CASE(in_an_image_too_small_for_what_lies_between_few_pixels_they_are_an_error_that_names_them) {
  Image psf = sampled({1.2 * cell_rad, 1.2 * cell_rad, 0}, 8, 8);
  BOOST_CHECK_EXCEPTION(fit_beam(psf, cell_rad), std::runtime_error, [](const std::exception& error) {
    const std::string message = error.what();
    return message.find(" 1 pixels") != message.npos && message.find("smaller cell") != message.npos;
  });
  psf.at(4, 4) = std::numeric_limits<double>::quiet_NaN();
  BOOST_CHECK_THROW(fit_beam(psf, cell_rad), std::runtime_error);
  BOOST_CHECK_THROW(fit_beam(Image(), cell_rad), std::runtime_error);
}

BOOST_AUTO_TEST_CASE(a_psf_without_slopes_is_an_error) {
  Image psf(16, 16);
  for (double& value : psf.pixel) value = 1;
  BOOST_CHECK_THROW(fit_beam(psf, cell_rad), std::runtime_error);
  BOOST_CHECK_THROW(fit_circular_beam(psf, cell_rad), std::runtime_error);
  for (int r = 0; r < 16; ++r)  // slopes as rounding makes them: a beam of 52 000 pixels
    for (int c = 0; c < 16; ++c) psf.at(r, c) = 1 - 1e-9 * ((r - 8) * (r - 8) + (c - 8) * (c - 8));
  BOOST_CHECK_THROW(fit_beam(psf, cell_rad), std::runtime_error);
  BOOST_CHECK_THROW(fit_circular_beam(psf, cell_rad), std::runtime_error);
}

BOOST_AUTO_TEST_CASE(a_round_beam_is_fitted_exactly_and_an_elongated_one_between_its_axes) {
  const Beam round{5.3 * cell_rad, 5.3 * cell_rad, 0};
  // The residual is 0 at the solution, and steps end below 1e-14 of it: what is left is the rounding of some twenty pixels.
  BOOST_TEST(std::abs(fit_circular_beam(sampled(round, 32, 32), cell_rad).major_rad / round.major_rad - 1) < 1e-12);
  const Beam between = fit_circular_beam(sampled(oblique, 65, 65), cell_rad);
  BOOST_TEST(between.major_rad == between.minor_rad);
  BOOST_TEST((between.major_rad > oblique.minor_rad && between.major_rad < oblique.major_rad));
}

BOOST_AUTO_TEST_CASE(a_lobe_that_is_open_along_one_axis_has_a_round_beam_alone) {
  Image psf(64, 64);
  for (int r = 0; r < 64; ++r)
    for (int c = 0; c < 64; ++c) psf.at(r, c) = std::exp(-(c - 32) * (c - 32) / 8.0);
  BOOST_CHECK_THROW(fit_beam(psf, cell_rad), std::runtime_error);
  // Wider than the lobe is across, σ = 2 pixels, and far from it: along its ridge the beam falls where the lobe stays at 1.
  const Beam beam = fit_circular_beam(psf, cell_rad);
  BOOST_TEST(beam.major_rad > 2 * std::sqrt(2 * std::log(2.0)) * 2 * cell_rad);
  BOOST_TEST(beam_misfit(psf, beam, cell_rad) > 0.1);
}

BOOST_AUTO_TEST_CASE(the_misfit_of_a_beam_is_0_for_its_own_psf_and_what_the_psf_differs_by) {
  Image psf = sampled(oblique, 65, 65);
  BOOST_TEST(beam_misfit(psf, oblique, cell_rad) < 1e-15);  // a few roundings of values up to 1
  for (double& pixel : psf.pixel) pixel += 0.05;
  // Whichever pixels the lobe has now, each differs by it, but for as few roundings.
  BOOST_TEST(std::abs(beam_misfit(psf, oblique, cell_rad) - 0.05) < 1e-15);
}

BOOST_AUTO_TEST_CASE(an_isolated_component_keeps_its_flux_as_its_peak) {
  Image model(21, 20);
  model.at(10, 5) = 2.7;
  BOOST_TEST(convolve_with_beam(model, oblique, cell_rad, 1).at(10, 5) == 2.7);
}

BOOST_AUTO_TEST_CASE(the_total_is_the_flux_times_the_sum_over_the_beam) {
  Image model(61, 61);
  model.at(30, 30) = 2;
  model.at(29, 33) = 1;
  double total = 0, beam_sum = 0;
  for (const double value : convolve_with_beam(model, oblique, cell_rad, 1).pixel) total += value;
  for (const double value : sampled(oblique, 61, 61).pixel) beam_sum += value >= 1e-8 ? value : 0;
  // 61² additions of positive numbers, with 2⁻⁵³ each at most: 4e-13, in both sums.
  BOOST_TEST(std::abs(total / (3 * beam_sum) - 1) < 1e-12);
}

BOOST_AUTO_TEST_CASE(convolution_equals_the_double_sum_over_pixels) {
  // Rounding of a few dozen additions; both leave out what lies below 1e-8 of the peak.
  const Image model = components(), fast = convolve_with_beam(model, oblique, cell_rad, 2);
  for (int r = 0; r < model.height; ++r)
    for (int c = 0; c < model.width; ++c) {
      double sum = 0;
      for (int y = 0; y < model.height; ++y)
        for (int x = 0; x < model.width; ++x) {
          const double height = gaussian(oblique, (x - c) * cell_rad, (r - y) * cell_rad);
          if (height >= 1e-8) sum += model.at(y, x) * height;
        }
      BOOST_REQUIRE(std::abs(fast.at(r, c) - sum) < 1e-12);
    }
}

BOOST_AUTO_TEST_CASE(a_model_pixel_that_is_nan_adds_nothing) {
  Image model = components();
  const Image without = convolve_with_beam(model, oblique, cell_rad, 1);
  model.at(5, 5) = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST((convolve_with_beam(model, oblique, cell_rad, 1).pixel == without.pixel));
}

BOOST_AUTO_TEST_CASE(what_is_restored_is_the_residual_and_the_model_at_the_resolution_of_the_beam) {
  const Image model = components(), convolved = convolve_with_beam(model, oblique, cell_rad, 1);
  Image residual(model.width, model.height);
  for (std::size_t i = 0; i < residual.pixel.size(); ++i) residual.pixel[i] = 0.01 * static_cast<double>(i);
  const Image image = restored({model, residual}, oblique, cell_rad, 2);
  for (std::size_t i = 0; i < image.pixel.size(); ++i) BOOST_TEST(image.pixel[i] == convolved.pixel[i] + residual.pixel[i]);
  BOOST_CHECK_THROW(restored({model, Image(3, 4)}, oblique, cell_rad, 1), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(convolution_gives_the_same_bits_on_any_number_of_threads) {
  const Image model = components(), one = convolve_with_beam(model, oblique, cell_rad, 1);
  for (const int threads : {2, 3, 50}) BOOST_TEST((convolve_with_beam(model, oblique, cell_rad, threads).pixel == one.pixel));
}

BOOST_AUTO_TEST_CASE(a_beam_wider_than_the_image_is_cut_at_its_border) {
  const Image out = convolve_with_beam(components(), {1.0, 1.0, 0}, cell_rad, 1);
  // Over 50 pixels of 1e-6 rad the beam falls by 4 ln 2 (5e-5)² = 7e-9: every pixel is the sum of the components, which are 7.9
  // in all by size, to 5e-8.
  for (const double value : out.pixel) BOOST_REQUIRE(std::abs(value - 7.375) < 1e-7);
}

BOOST_AUTO_TEST_CASE(a_beam_without_extent_is_an_error) {
  BOOST_CHECK_THROW(convolve_with_beam(components(), {cell_rad, 0, 0}, cell_rad, 1), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
