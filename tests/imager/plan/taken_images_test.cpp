#include "imager/plan/taken_images.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "imager/plan/accurate_imaging.h"
#include "tests/imager/comparison.h"
#include "tests/imager/several_stokes.h"

BOOST_AUTO_TEST_SUITE(taken_images)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double narrow = 1e-5, wide = 3e-3;  // pixels, so that w does not matter, or does

/// An image of two Stokes parameters.
struct Scene {
  GriddingRequest request;
  VisibilityBlock block;

  Scene(int width, int height, double cell_rad) : block(with_others(random_samples(300, 2, cell_rad, 1), 1, 2)) {
    request.geometry = {width, height, cell_rad, {}};
    request.samples = block.samples();
    request.stokes = 2;
    request.max_abs_w = 1000;
    request.threads = 2;
    for (std::size_t row = 0; row < block.rows(); ++row) block.uvw_m.edit()[3 * row + 2] = 20.0 * static_cast<double>(row % 7);
  }

  AccurateImages made(const TakenImages& taken = {}) const {
    GriddingRequest r = request;
    r.psf = !taken.psf;
    return make_accurate_images(stored({block}), plan_gridding(r), {}, nullptr, taken);
  }
};

TakenImages taking(const DirtyImages& images) {
  return {.dirty = true, .psf = true, .read = [&images] { return FormerImages{images.dirty, images.psf}; }};
}

/// Which image is refused when those of `images` are taken; "" where none is.
std::string refused(const Scene& scene, const DirtyImages& images) {
  try {
    scene.made(taking(images));
  } catch (const UnlikeSamples& unlike) {
    return unlike.kind.psf ? "psf" : "dirty " + std::to_string(unlike.kind.stokes);
  }
  return "";
}

}  // namespace

BOOST_DATA_TEST_CASE(images_of_the_same_samples_are_taken_as_they_are,
                     bdata::make({1, 2, 5, 48}) * bdata::make({narrow, wide}) * bdata::make({1, 2, 3}), size, cell_rad, which) {
  const Scene scene(size, size + 3, cell_rad);
  const AccurateImages anew = scene.made();
  TakenImages some = taking(anew.images);
  some.dirty = (which & 1) != 0;
  some.psf = (which & 2) != 0;
  const AccurateImages made = scene.made(some);
  constexpr double accuracy = 1e-6;  // that either keeps
  for (std::size_t s = 0; s < 2; ++s) {
    const SampleSums &sums = made.images.sums[s], &expected = anew.images.sums[s];
    BOOST_TEST(sums.used == expected.used);
    BOOST_TEST(sums.outside_grid == expected.outside_grid);
    BOOST_TEST(sums.weight == expected.weight, boost::test_tools::tolerance(1e-15 * 600));  // roundings of 600 samples
    BOOST_TEST(made.images.dirty_statistics[s].square_sum == statistics_of(made.images.dirty[s]).square_sum);
    BOOST_TEST(relative_error(made.images.dirty[s].pixel, anew.images.dirty[s].pixel) <= (some.dirty ? 0 : 2 * accuracy));
  }
  BOOST_TEST(relative_error(made.images.psf.pixel, anew.images.psf.pixel) <= (some.psf ? 0 : 2 * accuracy));
  BOOST_TEST(made.images.psf_statistics.square_sum == statistics_of(made.images.psf).square_sum);
}

BOOST_DATA_TEST_CASE(those_of_other_samples_weights_and_data_are_refused,
                     bdata::make({narrow, wide}) * bdata::make({1e-6, 1e-2}), cell_rad, accuracy) {
  Scene scene(48, 32, cell_rad);
  const DirtyImages images = scene.made().images;
  scene.request.accuracy = accuracy;
  BOOST_TEST(refused(scene, images) == "");
  Scene weights = scene, samples = scene, data = scene;
  for (std::size_t i = 0; i < weights.block.weight.size(); i += 3) weights.block.weight[i] *= 1.5F;
  BOOST_TEST(refused(weights, images) == "psf");
  for (std::size_t i = 0; i < samples.block.weight.size(); i += 5) samples.block.weight[i] = 0;
  BOOST_TEST(refused(samples, images) == "psf");
  for (std::size_t i = data.block.samples(); i < data.block.visibility.size(); ++i) data.block.visibility[i] *= 1.1F;
  BOOST_TEST(refused(data, images) == "dirty 1");
}

/// Without w, where it matters.
BOOST_AUTO_TEST_CASE(those_of_another_transform_are_refused) {
  Scene scene(48, 32, wide);
  scene.request.gridder = Gridder::standard;
  const DirtyImages flat = scene.made().images;
  scene.request.gridder = Gridder::wide;
  BOOST_TEST(refused(scene, flat) == "psf");
}

/// Wherever they are: a part of the image at its edge, turned round.
BOOST_AUTO_TEST_CASE(those_that_are_right_in_part_are_refused) {
  const Scene scene(48, 32, narrow);
  const DirtyImages right = scene.made().images;
  DirtyImages wrong = right;
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 48; ++column) wrong.dirty[0].at(row, column) *= -1;
  BOOST_TEST(refused(scene, wrong) == "dirty 0");
  wrong = right;
  wrong.psf.at(16, 24) = NAN;
  BOOST_TEST(refused(scene, wrong) == "psf");
}

BOOST_AUTO_TEST_CASE(residuals_of_a_model_are_not_compared_with_the_data) {
  const Scene scene(48, 32, narrow);
  DirtyImages images = scene.made().images;
  for (double& pixel : images.dirty[0].pixel) pixel *= 0.5;
  TakenImages taken = taking(images);
  taken.of_model = true;
  BOOST_TEST((scene.made(taken).images.dirty[0].pixel == images.dirty[0].pixel));
}

BOOST_AUTO_TEST_CASE(pixels_are_those_of_the_images) {
  const Scene scene(48, 32, wide);
  const AccurateImages made = scene.made();
  const ComparedPixels pixels(made.plan, made.transform->images());
  const DirtyImages values = make_dirty_images(stored({scene.block}), pixels.transform(), {.images = 2, .with_psf = true}, {});
  for (std::size_t s = 0; s < 2; ++s)
    BOOST_CHECK_NO_THROW(pixels.require(made.images.dirty[s], values.dirty[s], root_mean_square(made.images.dirty[s]), 0, {}));
  BOOST_CHECK_NO_THROW(pixels.require(made.images.psf, values.psf, root_mean_square(made.images.psf), 0, {.psf = true}));
  BOOST_TEST(values.psf.pixel.size() >= 32U);
}

BOOST_AUTO_TEST_SUITE_END()
