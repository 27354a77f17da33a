#include "imager/direct/direct_transform.h"

#include <boost/test/unit_test.hpp>
#include <numeric>

#include "imager/data/noise.h"
#include "imager/numerics/constants.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(direct_transform)

using namespace misfit::imager;
using namespace misfit::imager::testing;
using Complex = std::complex<double>;

namespace {

const ImageGeometry geometry{24, 17, 1e-3, {}};

/// Random samples with a w as long as u and v.
VisibilityBlock samples(std::size_t rows) {
  VisibilityBlock block = random_samples(rows, 3, geometry.cell_rad, 1);
  for (std::size_t row = 0; row < rows; ++row) block.uvw_m.edit()[3 * row + 2] = 0.7 * block.uvw_m[3 * (rows - 1 - row)];
  return block;
}

/// S exp(+2πi(ul + vm + w(n−1))).
Complex visibility_of(const Source& source, const double* uvw_m, double frequency_hz) {
  const double lambda_m = speed_of_light_m_s / frequency_hz;
  const auto [l, m] = source.position;
  const double n = std::cos(std::asin(std::hypot(l, m)));
  const double turns = (uvw_m[0] * l + uvw_m[1] * m + uvw_m[2] * (n - 1)) / lambda_m;
  return source.flux_jy * std::exp(Complex(0, 2 * pi * turns));
}

AdjointResult adjoint_of(const VisibilityBlock& block, const ImageGeometry& of = geometry) {
  const auto sum = DirectTransform(of, 2).adjoint({.with_psf = true});
  sum->add(block);
  return sum->finish();
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_point_source_gives_the_defining_phase_w_included) {
  const VisibilityBlock block = samples(40);
  const Source source{{0.31, -0.22}, 2.5};
  const auto predicted = predict_sources({source}, block, 2);
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    const Complex expected = visibility_of(source, &block.uvw_m[i / 3 * 3], block.frequency_hz[i % 3]);
    // Phases reach some 10³ rad, whose rounding is 1e-13.
    BOOST_TEST(std::abs(predicted[i] - expected) < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(w_is_left_out_where_it_is_not_wanted) {
  const VisibilityBlock block = samples(300);
  VisibilityBlock flat = block;
  for (std::size_t row = 0; row < flat.rows(); ++row) flat.uvw_m.edit()[3 * row + 2] = 0;
  const DirectTransform without({geometry, false, 2}), with({geometry, true, 2});
  const auto image_of = [](const DirectTransform& transform, const VisibilityBlock& of) {
    const auto sum = transform.adjoint({});
    sum->add(of);
    return sum->finish().images[0];
  };
  const Image model = random_image(geometry.width, geometry.height, 3);
  BOOST_TEST((image_of(without, block).pixel == image_of(with, flat).pixel));
  BOOST_TEST((image_of(without, block).pixel != image_of(with, block).pixel));
  BOOST_TEST((without.predict(model)->at(block) == with.predict(model)->at(flat)));
}

BOOST_AUTO_TEST_CASE(sources_add) {
  const VisibilityBlock block = samples(20);
  const Source a{{0.01, 0.02}, 1}, b{{-0.03, 0.005}, -0.5};
  auto sum = predict_sources({a}, block, 1);
  const auto of_b = predict_sources({b}, block, 1);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += of_b[i];
  BOOST_TEST(relative_error(predict_sources({a, b}, block, 1), sum) < 1e-15);
}

BOOST_AUTO_TEST_CASE(a_model_pixel_is_a_source_at_its_direction) {
  const VisibilityBlock block = samples(20);
  Image model(geometry.width, geometry.height);
  model.at(3, 20) = 1.5;
  const Source source{{-(20 - 12) * geometry.cell_rad, (3 - 8) * geometry.cell_rad}, 1.5};
  BOOST_TEST(relative_error(DirectTransform(geometry, 2).predict(model)->at(block), predict_sources({source}, block, 1)) <
             1e-12);
}

BOOST_AUTO_TEST_CASE(the_dirty_image_of_one_visibility_is_a_cosine_that_its_phase_moves) {
  VisibilityBlock block = samples(1);
  block.weight = {0, 1.5F, 0};
  block.visibility[1] = {0.6F, -0.8F};
  const double lambda_m = speed_of_light_m_s / block.frequency_hz[1];
  const AdjointResult result = adjoint_of(block);
  for (int row = 0; row < geometry.height; ++row)
    for (int column = 0; column < geometry.width; ++column) {
      const double l = -(column - 12) * geometry.cell_rad, m = (row - 8) * geometry.cell_rad;
      const double n = std::sqrt(1 - l * l - m * m);
      const double phase = 2 * pi / lambda_m * (block.uvw_m[0] * l + block.uvw_m[1] * m + block.uvw_m[2] * (n - 1));
      // The visibility's own phase, −arctan(4/3), shifts the cosine; 1e-7 is the rounding of a float.
      BOOST_TEST(std::abs(result.images[0].at(row, column) - 1.5 * std::cos(-std::atan2(0.8, 0.6) - phase)) < 2e-7);
      BOOST_TEST(std::abs(result.psf.at(row, column) - 1.5 * std::cos(phase)) < 1e-12);
    }
}

BOOST_AUTO_TEST_CASE(a_source_to_the_east_is_left_of_the_centre_and_one_to_the_north_in_a_higher_row) {
  VisibilityBlock block = samples(300);
  const Source source{{5 * geometry.cell_rad, 3 * geometry.cell_rad}, 1};
  const auto exact = predict_sources({source}, block, 1);
  block.visibility.assign(exact.begin(), exact.end());
  const AdjointResult result = adjoint_of(block);
  const Peak peak = find_peak(result.images[0]);
  BOOST_TEST(peak.column == 12 - 5);
  BOOST_TEST(peak.row == 8 + 3);
  BOOST_TEST(peak.value == result.sums[0].weight, boost::test_tools::tolerance(1e-6));  // the rounding of floats
}

BOOST_AUTO_TEST_CASE(the_psf_peaks_at_the_centre_at_the_sum_of_weights) {
  const VisibilityBlock block = samples(50);
  const AdjointResult result = adjoint_of(block);
  const double weight = std::accumulate(block.weight.begin(), block.weight.end(), 0.0);
  BOOST_TEST(result.psf.at(8, 12) == weight, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(find_peak(result.psf).value == result.psf.at(8, 12));
  BOOST_TEST(result.sums[0].weight == weight, boost::test_tools::tolerance(1e-13));
}

BOOST_AUTO_TEST_CASE(the_psf_is_the_image_of_a_source_in_the_middle_pixel_wherever_that_lies) {
  ImageGeometry off = geometry;
  off.centre = {0.3, -0.45};
  VisibilityBlock block = samples(50);
  const auto exact = predict_sources({{off.centre, 1}}, block, 1);
  block.visibility.assign(exact.begin(), exact.end());
  const AdjointResult result = adjoint_of(block, off);
  BOOST_TEST(result.psf.at(8, 12) == result.sums[0].weight, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(relative_error(result.images[0].pixel, result.psf.pixel) < 1e-6);  // the rounding of float visibilities
}

BOOST_AUTO_TEST_CASE(adjoint_is_the_transpose_of_prediction) {
  VisibilityBlock y = samples(60);
  std::fill(y.weight.begin(), y.weight.end(), 1.0F);
  const Image x = random_image(geometry.width, geometry.height, 2);
  const auto ax = DirectTransform(geometry, 2).predict(x)->at(y);
  const Image aty = adjoint_of(y).images[0];
  double left = 0, right = 0;
  for (std::size_t i = 0; i < ax.size(); ++i) left += std::real(ax[i] * std::conj(Complex(y.visibility[i])));
  for (std::size_t i = 0; i < x.pixel.size(); ++i) right += x.pixel[i] * aty.pixel[i];
  BOOST_TEST(std::abs(left - right) < 1e-12 * norm(x.pixel) * norm(aty.pixel));
}

BOOST_AUTO_TEST_CASE(a_few_pixels_equal_those_of_the_whole_image) {
  VisibilityBlock block = samples(40);
  block.uvw_m.edit()[0] *= 100;  // beyond the grid: left out of both
  block.weight[10] = 0;
  const AdjointResult whole = adjoint_of(block);
  const std::vector<Pixel> pixels{{0, 0}, {16, 23}, {8, 12}, {3, 20}};
  std::vector<std::vector<double>> sum(1, std::vector<double>(4, 1.0));
  add_direct_pixels(block, {geometry, pixels, true, 2}, sum);
  for (std::size_t k = 0; k < 4; ++k)
    BOOST_TEST(std::abs(sum[0][k] - 1 - whole.images[0].at(pixels[k].row, pixels[k].column)) <
               1e-12 * whole.sums[0].weight_abs);
  BOOST_TEST(whole.sums[0].outside_grid == 3U);
}

BOOST_AUTO_TEST_CASE(prediction_of_usable_samples_leaves_the_others_zero) {
  VisibilityBlock block = samples(10);
  block.weight[4] = 0;
  const auto prediction = DirectTransform(geometry, 1).predict(random_image(geometry.width, geometry.height, 3));
  auto expected = prediction->at(block);
  expected[4] = 0;
  BOOST_TEST((prediction->at_usable(block) == expected));
}

BOOST_AUTO_TEST_SUITE_END()
