#include "tools/paper/plain_gridder.h"

#include <algorithm>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "imager/coplanar/coplanar_transform.h"
#include "imager/direct/direct_transform.h"
#include "kernels/catalogue.h"
#include "tools/paper/card_scene.h"

BOOST_AUTO_TEST_SUITE(plain_gridder)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::tools;

namespace {

/// ‖is − should‖ / ‖should‖.
double relative_error(const imager::Image& is, const imager::Image& should) {
  double difference = 0;
  double norm = 0;
  for (std::size_t i = 0; i < is.pixel.size(); ++i) {
    difference += std::pow(is.pixel[i] - should.pixel[i], 2);
    norm += std::pow(should.pixel[i], 2);
  }
  return std::sqrt(difference / norm);
}

imager::Image image_by(const imager::Transform& transform, const CardScene& scene) {
  const auto sum = transform.adjoint({});
  sum->add(scene.block, scene.visibility);
  return sum->finish().images[0];
}

/// 56 × 40 pixels, 112 and 80 of which x0 = ¼ would make; both axes take an FFT of 112.
CardScene scene(const std::string& array) {
  CardScene made = card_scene({.pixels = 56, .cells_a_pixel = 15, .array = array, .integrations = 2});
  made.geometry.height = 40;
  for (std::size_t i = 0; i < made.visibility.size(); ++i)  // no symmetry that hides a wrong sign
    made.visibility[i] *= std::polar(1.0, 0.1 * static_cast<double>(i));
  return made;
}

constexpr int fft_size = 112;

imager::Image gridded(const CardScene& scene, const kernels::Kernel& kernel) {
  const Eigen::VectorXd h = kernels::optimal_correction(kernel.polynomial, pixel_offsets(scene.geometry.width, fft_size));
  return plain_image({scene.geometry, fft_size, kernel.polynomial, h}, scene.block, scene.visibility);
}

}  // namespace

BOOST_DATA_TEST_CASE(it_makes_the_image_that_the_coplanar_transform_makes, bdata::make({1, 2, 3, 6, 7}), width) {
  const CardScene s = scene("vla-c");
  const kernels::Kernel kernel = kernels::kernel_family("least-misfit").make(width, 0.25);
  const auto plane =
      imager::make_coplanar_transform({s.geometry, fft_size, fft_size, kernel, kernel, imager::Precision::double_precision, 1});
  // Sums of a thousand terms in another order, by FFTs of a hundred: some hundred roundings of 1e-16.
  BOOST_TEST(relative_error(gridded(s, kernel), image_by(*plane, s)) < 1e-13);
}

BOOST_DATA_TEST_CASE(its_prediction_is_the_adjoint_of_its_image, bdata::make({1, 2, 3, 6, 7}), width) {
  CardScene s = scene("vla-a");  // with samples that are left out
  for (std::size_t i = 0; i < s.block.weight.size(); ++i) s.block.weight[i] = 1 + 0.01F * static_cast<float>(i % 7);
  const kernels::Kernel kernel = kernels::kernel_family("least-misfit").make(width, 0.25);
  const Eigen::VectorXd h = kernels::optimal_correction(kernel.polynomial, pixel_offsets(s.geometry.width, fft_size));
  const PlainGridder gridder{s.geometry, fft_size, kernel.polynomial, h};
  imager::Image model(s.geometry.width, s.geometry.height);
  for (std::size_t i = 0; i < model.pixel.size(); ++i) model.pixel[i] = std::cos(1.7 * static_cast<double>(i * i % 1009));
  const std::vector<std::complex<double>> predicted = plain_prediction(gridder, model, s.block);
  const imager::Image image = plain_image(gridder, s.block, s.visibility);
  double by_pixels = 0, by_samples = 0, size = 0;
  for (std::size_t i = 0; i < model.pixel.size(); ++i) by_pixels += model.pixel[i] * image.pixel[i];
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    const double term = double{s.block.weight[i]} * (std::conj(predicted[i]) * s.visibility[i]).real();
    by_samples += term;
    size += std::abs(term);
  }
  // Sums of a thousand terms in another order.
  BOOST_TEST(std::abs(by_pixels - by_samples) < 1e-12 * size);
}

BOOST_AUTO_TEST_CASE(it_errs_by_no_more_than_its_kernel) {
  const CardScene s = scene("vla-c");
  const imager::DirectTransform direct({s.geometry, false, 1});
  for (const int width : {4, 7, 10}) {
    const kernels::Kernel kernel = kernels::kernel_family("least-misfit").make(width, 0.25);
    // Half as much again for 702 positions that stand for all, and for 40 rows that stand for 56.
    BOOST_TEST(relative_error(gridded(s, kernel), image_by(direct, s)) < 1.5 * std::sqrt(2 * kernel.misfit.mean));
  }
}

BOOST_AUTO_TEST_CASE(samples_that_the_pixels_cannot_represent_are_left_out) {
  const CardScene s = scene("vla-a");  // ten times as far as 1/(2 cell)
  const imager::DirectTransform direct({s.geometry, false, 1});
  const kernels::Kernel kernel = kernels::kernel_family("least-misfit").make(8, 0.25);
  const auto sum = direct.adjoint({});
  sum->add(s.block, s.visibility);
  BOOST_REQUIRE(sum->finish().sums[0].outside_grid > 0);
  BOOST_TEST(relative_error(gridded(s, kernel), image_by(direct, s)) < 1.5 * std::sqrt(2 * kernel.misfit.mean));
}

BOOST_AUTO_TEST_SUITE_END()
