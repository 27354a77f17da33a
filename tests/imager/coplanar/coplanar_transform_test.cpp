#include "imager/coplanar/coplanar_transform.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "imager/direct/direct_transform.h"
#include "imager/numerics/fft.h"
#include "kernels/catalogue.h"
#include "kernels/evaluation.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(coplanar_transform)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::imager;
using misfit::imager::testing::random_samples;

namespace {

constexpr double cell_rad = 1e-5;

CoplanarOptions options(int width, int height, int kernel_width, double padding, const std::string& family = "least-misfit") {
  CoplanarOptions o;
  o.geometry = {width, height, cell_rad, {}};
  o.nu = fast_fft_size(std::max(static_cast<int>(padding * width), 4 * kernel_width));
  o.nv = fast_fft_size(std::max(static_cast<int>(padding * height), 4 * kernel_width));
  const auto kernel = [&](int pixels, int fft) {
    return kernels::kernel_family(family).make(kernel_width, std::clamp(0.5 * pixels / fft, 0.05, 0.49));
  };
  o.kernel_u = kernel(width, o.nu);
  o.kernel_v = kernel(height, o.nv);
  o.threads = 2;
  return o;
}

double norm(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += v * v;
  return std::sqrt(sum);
}

double relative_error(const std::vector<double>& is, const std::vector<double>& should) {
  std::vector<double> difference(is.size());
  for (std::size_t i = 0; i < is.size(); ++i) difference[i] = is[i] - should[i];
  return norm(difference) / norm(should);
}

AdjointResult adjoint_of(const Transform& transform, const VisibilityBlock& block) {
  const auto sum = transform.adjoint({.with_psf = true});
  sum->add(block);
  return sum->finish();
}

/// What theory expects of random data: two axes add their E, and a finite sample strays from the mean by much less than half.
double expected_error(const CoplanarOptions& o) {
  return std::sqrt(o.kernel_u.misfit.mean + o.kernel_v.misfit.mean);
}

Image random_image(int width, int height, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Image image(width, height);
  for (double& pixel : image.pixel) pixel = normal(random);
  return image;
}

std::vector<double> parts(const std::vector<std::complex<double>>& z) {
  std::vector<double> out;
  for (const auto& v : z) {
    out.push_back(v.real());
    out.push_back(v.imag());
  }
  return out;
}

}  // namespace

BOOST_DATA_TEST_CASE(dirty_image_and_psf_equal_the_direct_transform_within_the_kernel_error,
                     bdata::xrange(1, 12) * bdata::make({1.25, 1.5, 2.0}) * bdata::make({1, 3}), kernel_width, padding,
                     channels) {
  const CoplanarOptions o = options(64, 48, kernel_width, padding);
  const VisibilityBlock block =
      random_samples(450U / static_cast<unsigned>(channels), static_cast<std::size_t>(channels), cell_rad, 1);
  const AdjointResult gridded = adjoint_of(*make_coplanar_transform(o), block);
  const AdjointResult direct = adjoint_of(DirectTransform(o.geometry, 2), block);
  // The dirty image of random data has random phases. 1e-14 is the rounding of doubles.
  BOOST_TEST(relative_error(gridded.images[0].pixel, direct.images[0].pixel) < 1.5 * expected_error(o) + 1e-14);
  // The PSF's phases are not random, but no sample's error exceeds the worst position's.
  const double worst = std::sqrt(o.kernel_u.misfit.worst_mean + o.kernel_v.misfit.worst_mean);
  BOOST_TEST(relative_error(gridded.psf.pixel, direct.psf.pixel) < 1.5 * worst + 1e-14);
  BOOST_TEST(gridded.sums[0].used == block.samples());
  BOOST_TEST(gridded.sums[0].weight == direct.sums[0].weight, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(the_error_of_random_data_is_what_theory_expects_down_to_rounding, *boost::unit_test::label("sweep")) {
  const VisibilityBlock block = random_samples(400, 3, cell_rad, 9);
  const Image model = random_image(128, 128, 10);
  const DirectTransform direct(options(128, 128, 2, 2.0).geometry, 2);
  const std::vector<double> image = adjoint_of(direct, block).images[0].pixel;
  const std::vector<double> visibilities = parts(direct.predict(model)->at(block));
  for (const int width : {2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 17, 20}) {
    const CoplanarOptions o = options(128, 128, width, 2.0);
    BOOST_REQUIRE(o.kernel_u.x0 == 0.25);
    const auto transform = make_coplanar_transform(o);
    const double of_image = relative_error(adjoint_of(*transform, block).images[0].pixel, image);
    const double of_visibilities = relative_error(parts(transform->predict(model)->at(block)), visibilities);
    BOOST_TEST_CONTEXT("width " << width << ", expected " << expected_error(o)) {
      if (width <= 12) {
        // 1200 samples stray from the mean over positions by several percent.
        BOOST_TEST(std::abs(of_image / expected_error(o) - 1) < 0.2);
        BOOST_TEST(std::abs(of_visibilities / expected_error(o) - 1) < 0.2);
      } else {
        // Rounding of taps, sums and phases of some hundred turns in the direct sums.
        BOOST_TEST(of_image < 1e-13);
        BOOST_TEST(of_visibilities < 1e-13);
      }
    }
  }
}

BOOST_DATA_TEST_CASE(predicted_visibilities_equal_the_direct_transform_within_the_kernel_error,
                     bdata::xrange(1, 12) * bdata::make({1.25, 2.0}) * bdata::make({1, 2}), kernel_width, padding, channels) {
  const CoplanarOptions o = options(64, 48, kernel_width, padding);
  const VisibilityBlock block = random_samples(300, static_cast<std::size_t>(channels), cell_rad, 2);
  const Image model = random_image(64, 48, 3);
  const auto gridded = parts(make_coplanar_transform(o)->predict(model)->at(block));
  const auto direct = parts(DirectTransform(o.geometry, 2).predict(model)->at(block));
  BOOST_TEST(relative_error(gridded, direct) < 1.5 * expected_error(o) + 1e-14);
}

/// Tiles of many samples have a buffer of their own, others are gridded where they lie.
BOOST_DATA_TEST_CASE(tiles_of_few_and_of_many_samples_are_as_exact, bdata::make({1, 10, 100, 1000, 5000}), rows) {
  const CoplanarOptions o = options(64, 48, 10, 1.5);
  const VisibilityBlock block = random_samples(static_cast<std::size_t>(rows), 3, cell_rad, 4);
  const Image model = random_image(64, 48, 5);
  const auto transform = make_coplanar_transform(o);
  const DirectTransform direct(o.geometry, 2);
  const double worst = std::sqrt(o.kernel_u.misfit.worst_mean + o.kernel_v.misfit.worst_mean);
  const AdjointResult gridded = adjoint_of(*transform, block), should = adjoint_of(direct, block);
  BOOST_TEST(relative_error(gridded.images[0].pixel, should.images[0].pixel) < 1.5 * worst);
  BOOST_TEST(relative_error(gridded.psf.pixel, should.psf.pixel) < 1.5 * worst);
  BOOST_TEST(relative_error(parts(transform->predict(model)->at(block)), parts(direct.predict(model)->at(block))) <
             1.5 * worst);
}

BOOST_DATA_TEST_CASE(image_shapes_odd_thin_and_tiny_are_as_exact,
                     bdata::make({331, 7, 1, 1, 64, 2}) ^ bdata::make({17, 50, 1, 40, 1, 3}), width, height) {
  const CoplanarOptions o = options(width, height, 7, 2.0);
  const VisibilityBlock block = random_samples(60, 2, cell_rad, 4);
  const AdjointResult gridded = adjoint_of(*make_coplanar_transform(o), block);
  const AdjointResult direct = adjoint_of(DirectTransform(o.geometry, 1), block);
  // A handful of pixels is no average over the field: the largest error at the worst position bounds it.
  const double bound = std::sqrt(o.kernel_u.misfit.worst) + std::sqrt(o.kernel_v.misfit.worst);
  const double data = std::sqrt(direct.sums[0].weight2_square * static_cast<double>(o.geometry.pixels()));
  std::vector<double> difference(gridded.images[0].pixel.size());
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] = gridded.images[0].pixel[i] - direct.images[0].pixel[i];
  BOOST_TEST(norm(difference) < 3 * bound * data);
}

BOOST_DATA_TEST_CASE(adjoint_is_the_transpose_of_prediction,
                     bdata::make({1, 2, 5, 8, 11, 15, 20}) * bdata::make({0.0, 0.2}) * bdata::make({1, 3}), kernel_width,
                     offset, channels) {
  CoplanarOptions o = options(50, 37, kernel_width, 1.3);
  o.geometry.centre = {offset, -offset / 3};
  const auto transform = make_coplanar_transform(o);
  VisibilityBlock y = random_samples(200, static_cast<std::size_t>(channels), cell_rad, 5);
  std::fill(y.weight.begin(), y.weight.end(), 1.0F);
  const Image x = random_image(50, 37, 6);
  const auto ax = transform->predict(x)->at(y);
  const Image aty = adjoint_of(*transform, y).images[0];
  double left = 0;
  for (std::size_t i = 0; i < ax.size(); ++i) left += std::real(ax[i] * std::conj(std::complex<double>(y.visibility[i])));
  double right = 0;
  for (std::size_t i = 0; i < x.pixel.size(); ++i) right += x.pixel[i] * aty.pixel[i];
  BOOST_TEST(std::abs(left - right) < 1e-12 * norm(x.pixel) * norm(aty.pixel));
}

BOOST_DATA_TEST_CASE(result_is_the_same_bit_for_bit_for_any_number_of_threads, bdata::make({true, false}), single) {
  CoplanarOptions o = options(200, 150, 6, 1.5);
  o.precision = single ? Precision::single_precision : Precision::double_precision;
  const VisibilityBlock block = random_samples(3000, 4, cell_rad, 7);
  const Image model = random_image(200, 150, 8);
  o.threads = 1;
  const AdjointResult one = adjoint_of(*make_coplanar_transform(o), block);
  const auto predicted = make_coplanar_transform(o)->predict(model)->at(block);
  for (const int threads : {2, 3, 7}) {
    o.threads = threads;
    const AdjointResult many = adjoint_of(*make_coplanar_transform(o), block);
    BOOST_TEST((many.images[0].pixel == one.images[0].pixel));
    BOOST_TEST((many.psf.pixel == one.psf.pixel));
    BOOST_TEST(many.sums[0].weight_square == one.sums[0].weight_square);
    BOOST_TEST((make_coplanar_transform(o)->predict(model)->at(block) == predicted));
  }
}

BOOST_AUTO_TEST_CASE(single_precision_is_exact_to_its_rounding) {
  CoplanarOptions o = options(128, 128, 8, 2.0);
  o.precision = Precision::single_precision;
  const VisibilityBlock block = random_samples(2000, 2, cell_rad, 9);
  const AdjointResult gridded = adjoint_of(*make_coplanar_transform(o), block);
  const AdjointResult direct = adjoint_of(DirectTransform(o.geometry, 2), block);
  // 6e-8 per operation, of which taps, sums and the FFT add a few dozen in quadrature.
  BOOST_TEST(relative_error(gridded.images[0].pixel, direct.images[0].pixel) < 1e-6);
}

BOOST_AUTO_TEST_CASE(samples_on_the_edge_of_the_grid_count_and_those_beyond_do_not) {
  const CoplanarOptions o = options(40, 40, 8, 1.5);
  VisibilityBlock block = random_samples(6, 1, cell_rad, 10);
  const double edge = speed_of_light_m_s / block.frequency_hz[0] / (2 * cell_rad);
  const double u[] = {edge, -edge, 0, 0, 1.001 * edge, 0};
  const double v[] = {0, edge, -edge, edge, 0, -1.001 * edge};
  for (std::size_t row = 0; row < 6; ++row) {
    block.uvw_m.edit()[3 * row] = u[row] * (1 - 1e-15);
    block.uvw_m.edit()[3 * row + 1] = v[row] * (1 - 1e-15);
  }
  const AdjointResult gridded = adjoint_of(*make_coplanar_transform(o), block);
  const AdjointResult direct = adjoint_of(DirectTransform(o.geometry, 1), block);
  BOOST_TEST(gridded.sums[0].used == 4U);
  BOOST_TEST(gridded.sums[0].outside_grid == 2U);
  BOOST_TEST(direct.sums[0].outside_grid == 2U);
  const double bound = std::sqrt(o.kernel_u.misfit.worst_mean + o.kernel_v.misfit.worst_mean);
  BOOST_TEST(relative_error(gridded.images[0].pixel, direct.images[0].pixel) < 2 * bound);
}

BOOST_DATA_TEST_CASE(prediction_beyond_the_grid_is_periodic_and_exact, bdata::make({1, 2}) * bdata::make({1.3, 7.3}), channels,
                     reach) {
  const CoplanarOptions o = options(40, 30, 8, 2.0);
  const VisibilityBlock block = random_samples(200, static_cast<std::size_t>(channels), cell_rad, 11, reach);
  const Image model = random_image(40, 30, 12);
  const auto gridded = parts(make_coplanar_transform(o)->predict(model)->at(block));
  const auto direct = parts(DirectTransform(o.geometry, 2).predict(model)->at(block));
  BOOST_TEST(relative_error(gridded, direct) < 1.5 * expected_error(o));
}

BOOST_DATA_TEST_CASE(images_off_the_phase_centre_are_as_exact,
                     bdata::xrange(1, 12) * bdata::make({0.37 * cell_rad, 0.3, -0.5}) * bdata::make({1, 3}), kernel_width,
                     offset, channels) {
  CoplanarOptions o = options(64, 48, kernel_width, 1.6);
  o.geometry.centre = {offset, -0.4 * offset};
  const auto transform = make_coplanar_transform(o);
  const DirectTransform exact(o.geometry, 2);
  const VisibilityBlock block = random_samples(150, static_cast<std::size_t>(channels), cell_rad, 1);
  const AdjointResult gridded = adjoint_of(*transform, block), direct = adjoint_of(exact, block);
  constexpr double rounding = 1e-10;  // of phases of 10⁴ turns
  BOOST_TEST(relative_error(gridded.images[0].pixel, direct.images[0].pixel) < 1.5 * expected_error(o) + rounding);
  const double worst = std::sqrt(o.kernel_u.misfit.worst_mean + o.kernel_v.misfit.worst_mean);
  BOOST_TEST(relative_error(gridded.psf.pixel, direct.psf.pixel) < 1.5 * worst + rounding);

  const VisibilityBlock beyond = random_samples(300, 2, cell_rad, 2, 2.3);
  const Image model = random_image(64, 48, 3);
  BOOST_TEST(relative_error(parts(transform->predict(model)->at(beyond)), parts(exact.predict(model)->at(beyond))) <
             1.5 * expected_error(o) + rounding);
}

BOOST_AUTO_TEST_CASE(single_precision_off_the_phase_centre_is_exact_to_its_rounding) {
  CoplanarOptions o = options(128, 128, 8, 2.0);
  o.precision = Precision::single_precision;
  o.geometry.centre = {0.4, 0.3};
  const VisibilityBlock block = random_samples(2000, 2, cell_rad, 9);
  const Image model = random_image(128, 128, 10);
  const auto transform = make_coplanar_transform(o);
  const DirectTransform exact(o.geometry, 2);
  // As at the phase centre: the phases of 10⁴ turns are not rounded to floats.
  BOOST_TEST(relative_error(adjoint_of(*transform, block).images[0].pixel, adjoint_of(exact, block).images[0].pixel) < 1e-6);
  BOOST_TEST(relative_error(parts(transform->predict(model)->at(block)), parts(exact.predict(model)->at(block))) < 1e-6);
}

BOOST_AUTO_TEST_CASE(the_psf_does_not_depend_on_the_offset_from_the_phase_centre) {
  CoplanarOptions o = options(64, 48, 7, 1.6);
  const VisibilityBlock block = random_samples(150, 3, cell_rad, 1);
  const AdjointResult centred = adjoint_of(*make_coplanar_transform(o), block);
  o.geometry.centre = {0.3, -0.1};
  BOOST_TEST((adjoint_of(*make_coplanar_transform(o), block).psf.pixel == centred.psf.pixel));
  // The worst relative error of a pixel at the worst position is √worst on each axis.
  BOOST_TEST(std::abs(centred.psf.at(24, 32) / centred.sums[0].weight - 1) <
             std::sqrt(o.kernel_u.misfit.worst) + std::sqrt(o.kernel_v.misfit.worst));
}

BOOST_AUTO_TEST_CASE(pixels_beyond_the_horizon_are_nan_and_predict_nothing) {
  CoplanarOptions o = options(60, 50, 7, 1.6);
  o.geometry.cell_rad = 0.02;
  o.geometry.centre = {-0.501, 0.403};
  const auto transform = make_coplanar_transform(o);
  const VisibilityBlock block = random_samples(150, 1, o.geometry.cell_rad, 1);
  const AdjointResult gridded = adjoint_of(*transform, block);
  Image model = random_image(60, 50, 3), cut = model;
  std::size_t beyond = 0;
  for (int row = 0; row < 50; ++row)
    for (int column = 0; column < 60; ++column) {
      const bool nan = std::hypot(o.geometry.l(column), o.geometry.m(row)) > 1;
      BOOST_REQUIRE(std::isnan(gridded.images[0].at(row, column)) == nan);
      BOOST_REQUIRE(std::isnan(gridded.psf.at(row, column)) == nan);
      if (!nan) continue;
      ++beyond;
      model.at(row, column) = beyond % 2 == 0 ? 1e6 : std::nan("");
      cut.at(row, column) = 0;
    }
  BOOST_TEST(beyond > 500U);
  const auto predicted = transform->predict(model)->at(block);
  BOOST_TEST((predicted == transform->predict(cut)->at(block)));
  BOOST_TEST(relative_error(parts(predicted), parts(DirectTransform(o.geometry, 2).predict(cut)->at(block))) <
             2 * expected_error(o));
}

BOOST_AUTO_TEST_CASE(samples_of_weight_zero_neither_image_nor_predict) {
  const CoplanarOptions o = options(40, 30, 6, 1.5);
  VisibilityBlock block = random_samples(50, 2, cell_rad, 13);
  VisibilityBlock kept = block;
  for (std::size_t i = 0; i < block.samples(); i += 3) {
    block.weight[i] = 0;
    block.visibility[i] = {std::nanf(""), 1};
    kept.weight[i] = 0;
  }
  const auto transform = make_coplanar_transform(o);
  BOOST_TEST((adjoint_of(*transform, block).images[0].pixel == adjoint_of(*transform, kept).images[0].pixel));
  const auto prediction = transform->predict(random_image(40, 30, 14));
  const auto all = prediction->at(block);
  const auto usable = prediction->at_usable(block);
  for (std::size_t i = 0; i < all.size(); ++i)
    BOOST_TEST(usable[i] == (block.weight[i] == 0 ? std::complex<double>(0) : all[i]));
}

BOOST_AUTO_TEST_CASE(replaced_visibilities_are_gridded_like_the_blocks_own) {
  const CoplanarOptions o = options(40, 30, 6, 1.5);
  const VisibilityBlock block = random_samples(50, 2, cell_rad, 15);
  const auto transform = make_coplanar_transform(o);
  const auto sum = transform->adjoint({});
  sum->add(block, std::vector<std::complex<double>>(block.visibility.begin(), block.visibility.end()));
  const AdjointResult replaced = sum->finish();
  BOOST_TEST((replaced.images[0].pixel == adjoint_of(*transform, block).images[0].pixel));
  BOOST_TEST(replaced.psf.pixel.empty());
}

BOOST_AUTO_TEST_CASE(a_single_visibility_is_exact_within_the_worst_position) {
  const CoplanarOptions o = options(64, 64, 7, 2.0);
  const double bound = std::sqrt(o.kernel_u.misfit.worst_mean + o.kernel_v.misfit.worst_mean);
  for (unsigned seed = 0; seed < 30; ++seed) {
    const VisibilityBlock block = random_samples(1, 1, cell_rad, seed);
    const AdjointResult gridded = adjoint_of(*make_coplanar_transform(o), block);
    const AdjointResult direct = adjoint_of(DirectTransform(o.geometry, 1), block);
    BOOST_TEST(relative_error(gridded.images[0].pixel, direct.images[0].pixel) < 1.5 * bound);
  }
}

BOOST_AUTO_TEST_CASE(contradicting_options_are_refused) {
  CoplanarOptions o = options(64, 64, 6, 1.5);
  o.nu = 60;
  BOOST_CHECK_THROW(make_coplanar_transform(o), std::invalid_argument);
  o = options(64, 64, 6, 2.0);
  o.nv = 80;
  BOOST_CHECK_THROW(make_coplanar_transform(o), std::invalid_argument);
  o = options(64, 64, 6, 1.5);
  o.kernel_v = kernels::kernel_family("least-misfit").make(5, o.kernel_v.x0);
  BOOST_CHECK_THROW(make_coplanar_transform(o), std::invalid_argument);
}

BOOST_DATA_TEST_CASE(tables_err_by_what_theory_says_of_them, bdata::xrange(0, 4) * bdata::make({16, 200}), degree, samples) {
  CoplanarOptions o = options(64, 48, 6, 2);
  o.lookup = kernels::TableOptions{samples, static_cast<kernels::Interpolation>(degree)};
  const VisibilityBlock block = random_samples(500, 4, cell_rad, 8);
  const DirectTransform direct(o.geometry, 2);
  const auto transform = make_coplanar_transform(o);
  const auto mean = [&](const kernels::Kernel& k) { return judge_table(k.polynomial, k.misfit, *o.lookup, k.x0).mean; };
  const double u = mean(o.kernel_u), v = mean(o.kernel_v);
  const double error = relative_error(adjoint_of(*transform, block).images[0].pixel, adjoint_of(direct, block).images[0].pixel);
  // Linear tables make taps too small on average, so that the errors of both axes add up in part: to 1.21 √(u + v) where E of
  // the function is nothing, since the mean of p(1−p)/2, squared, is 5/6 of its mean square, and that of x² 5/9. The rest is
  // 2000 samples and 3072 pixels.
  constexpr double tolerance = 0.25;
  BOOST_TEST(error == std::sqrt(u + v), boost::test_tools::tolerance(tolerance));
  const Image model = random_image(64, 48, 3);
  const auto at = [&](const Transform& way) { return parts(way.predict(model)->at(block)); };
  BOOST_TEST(relative_error(at(*transform), at(direct)) == std::sqrt(u + v), boost::test_tools::tolerance(tolerance));
}

BOOST_AUTO_TEST_SUITE_END()
