#include "imager/transform/imaging.h"

#include <boost/test/unit_test.hpp>
#include <numeric>

#include "imager/direct/direct_transform.h"
#include "imager/plan/gridding_plan.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(imaging)

using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double accuracy = 1e-6;
const ImageGeometry geometry{60, 44, 1e-5, {}};

std::unique_ptr<Transform> gridded() {
  GriddingRequest request;
  request.geometry = geometry;
  request.accuracy = accuracy;
  request.threads = 2;
  return make_coplanar_transform(plan_gridding(request).options);
}

/// Blocks that saw `model`, without error but the rounding of floats.
std::vector<VisibilityBlock> observed(const Image& model) {
  std::vector<VisibilityBlock> blocks{random_samples(200, 2, geometry.cell_rad, 1),
                                      random_samples(70, 5, geometry.cell_rad, 2)};
  const auto prediction = DirectTransform(geometry, 2).predict(model);
  for (VisibilityBlock& block : blocks) {
    const auto exact = prediction->at(block);
    block.visibility.assign(exact.begin(), exact.end());
  }
  return blocks;
}

}  // namespace

BOOST_AUTO_TEST_CASE(dirty_image_and_psf_are_the_direct_ones_over_the_sum_of_weights) {
  const std::vector<VisibilityBlock> blocks = observed(random_image(60, 44, 3));
  const DirtyImages is = make_dirty_images(stored(blocks), *gridded(), {.with_psf = true}, {});
  const auto sum = DirectTransform(geometry, 2).adjoint({.with_psf = true});
  for (const VisibilityBlock& block : blocks) sum->add(block);
  AdjointResult should = sum->finish();
  for (Image* image : {&should.images[0], &should.psf})
    for (double& pixel : image->pixel) pixel /= should.sums[0].weight;
  BOOST_TEST(relative_error(is.dirty[0].pixel, should.images[0].pixel) < accuracy);
  BOOST_TEST(relative_error(is.psf.pixel, should.psf.pixel) < accuracy);
  BOOST_TEST(is.psf.at(22, 30) == 1, boost::test_tools::tolerance(1e-5));
  BOOST_TEST(is.sums[0].used == 200U * 2 + 70U * 5);
}

BOOST_AUTO_TEST_CASE(the_residual_of_the_true_model_is_zero_to_the_accuracy) {
  const Image model = random_image(60, 44, 4);
  const StoredVisibilities source = stored(observed(model));
  const auto transform = gridded();
  const DirtyImages images = make_dirty_images(source, *transform, AdjointOptions{}, {});
  const Image residual = make_residual_image({source, *transform, images.normalisation}, model, {});
  BOOST_TEST(norm(residual.pixel) < accuracy * norm(images.dirty[0].pixel));
}

BOOST_AUTO_TEST_CASE(the_residual_of_no_model_is_the_dirty_image) {
  const StoredVisibilities source = stored(observed(random_image(60, 44, 5)));
  const auto transform = gridded();
  const DirtyImages images = make_dirty_images(source, *transform, AdjointOptions{}, {});
  const Image residual = make_residual_image({source, *transform, images.normalisation}, Image(60, 44), {});
  BOOST_TEST((residual.pixel == images.dirty[0].pixel));
  BOOST_TEST(images.psf.pixel.empty());
}

/// A sensitivity from 0.2 to 9, and 0 in a corner.
Image some_sensitivity() {
  Image sensitivity = random_image(60, 44, 8);
  for (double& pixel : sensitivity.pixel) pixel = 0.2 + 8.8 * std::abs(std::tanh(pixel));
  sensitivity.at(0, 0) = 0;
  return sensitivity;
}

/// As a mosaic has them: of flat noise D/(√W √max W) and models the sky times √(W/max W), else D/W and models the sky.
BOOST_AUTO_TEST_CASE(residuals_of_mosaics_are_normalised_by_their_sensitivity) {
  const Image seen = random_image(60, 44, 6), model = random_image(60, 44, 7), sensitivity = some_sensitivity();
  const double largest = *std::max_element(sensitivity.pixel.begin(), sensitivity.pixel.end());
  const std::vector<VisibilityBlock> blocks = observed(seen);
  const StoredVisibilities source = stored(blocks);
  const auto transform = gridded();
  for (const bool flat_noise : {true, false}) {
    const Normalisation by(sensitivity, flat_noise, 3, 4);
    Image residual = make_residual_image({source, *transform, by}, model, {});

    Image left = seen;  // data are those of `seen`
    for (std::size_t i = 1; i < left.pixel.size(); ++i)
      left.pixel[i] -= model.pixel[i] / (flat_noise ? std::sqrt(sensitivity.pixel[i] / largest) : 1);
    const auto sum = DirectTransform(geometry, 2).adjoint({});
    for (const VisibilityBlock& block : observed(left)) sum->add(block);
    Image should = sum->finish().images[0];
    for (std::size_t i = 1; i < should.pixel.size(); ++i)
      should.pixel[i] /= flat_noise ? std::sqrt(sensitivity.pixel[i] * largest) : sensitivity.pixel[i];
    BOOST_TEST(std::isnan(residual.pixel[0]));  // what no beam sees
    residual.pixel[0] = should.pixel[0] = 0;
    BOOST_TEST(relative_error(residual.pixel, should.pixel) < 4 * accuracy);  // where W is small it weighs more
  }
}

/// ⟨V, A F m⟩ = ⟨F A* V, m⟩: CLEAN of an image that is divided by the factor its model is divided by.
BOOST_AUTO_TEST_CASE(flat_noise_keeps_operators_adjoint) {
  Image sensitivity = some_sensitivity();
  sensitivity.at(0, 0) = 1;
  const Normalisation normalisation(sensitivity, true, 3, 4);
  Image model = random_image(60, 44, 11);
  const VisibilityBlock block = observed(random_image(60, 44, 12)).front();
  const DirectTransform transform(geometry, 2);
  const auto sum = transform.adjoint({});
  sum->add(block);
  Image image = sum->finish().images[0];
  normalisation.make_image(image);
  const double in_images = std::inner_product(image.pixel.begin(), image.pixel.end(), model.pixel.begin(), 0.0);
  normalisation.make_predicted(model);
  const auto predicted = transform.predict(model)->at(block);
  double in_samples = 0;
  for (std::size_t i = 0; i < block.samples(); ++i)
    in_samples += double{block.weight[i]} * (std::conj(std::complex<double>(block.visibility[i])) * predicted[i]).real();
  BOOST_TEST(normalisation.weight() * in_images == in_samples, boost::test_tools::tolerance(1e-10));
}

BOOST_AUTO_TEST_CASE(progress_ends_at_all_samples_and_every_stage_is_timed) {
  const StoredVisibilities source = stored(observed(Image(60, 44)));
  std::vector<std::uint64_t> seen;
  const auto progress = [&](std::uint64_t done, std::uint64_t total) {
    BOOST_TEST(total == source.samples());
    seen.push_back(done);
  };
  StageTimes times;
  make_dirty_images(source, *gridded(), {}, {.times = &times, .progress = progress});
  BOOST_TEST((seen == std::vector<std::uint64_t>{400, 750}));
  std::vector<std::string> stages;
  for (const auto& [stage, seconds] : times.stages()) stages.push_back(stage);
  BOOST_TEST((stages == std::vector<std::string>{"grid", "read", "fft"}));
}

BOOST_AUTO_TEST_CASE(no_usable_sample_is_an_error_that_counts_those_outside) {
  VisibilityBlock outside = random_samples(5, 2, geometry.cell_rad, 6);
  for (std::size_t row = 0; row < 5; ++row) outside.uvw_m.edit()[3 * row] = 1e9;
  BOOST_CHECK_EXCEPTION(
      make_dirty_images(stored({outside}), *gridded(), {.with_psf = true}, {}), std::runtime_error,
      [](const std::exception& error) { return std::string(error.what()).find(" 10 usable samples") != std::string::npos; });
  BOOST_CHECK_THROW(make_dirty_images(stored({}), *gridded(), {.with_psf = true}, {}), std::runtime_error);
}

BOOST_AUTO_TEST_SUITE_END()
