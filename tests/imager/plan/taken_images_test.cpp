#include "imager/plan/taken_images.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <tuple>

#include "imager/plan/accurate_imaging.h"
#include "tests/imager/comparison.h"
#include "tests/imager/several_stokes.h"

BOOST_AUTO_TEST_SUITE(taken_images)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

/// An image of two Stokes parameters, with a w axis where the cell is large.
struct Scene {
  GriddingRequest request;
  VisibilityBlock block;

  Scene(int width, int height, double cell_rad) : block(with_others(random_samples(300, 2, cell_rad, 1), 1, 2)) {
    request.geometry = {width, height, cell_rad, {}};
    request.samples = block.samples();
    request.stokes = 2;
    request.max_abs_w = 100;
    request.threads = 2;
    for (std::size_t row = 0; row < block.rows(); ++row) block.uvw_m.edit()[3 * row + 2] = 20.0 * static_cast<double>(row % 7);
  }

  AccurateImages made(TakenImages taken = {}) const {
    GriddingRequest r = request;
    r.psf = !taken.psf;
    return make_accurate_images(stored({block}), plan_gridding(r), {}, nullptr, std::move(taken));
  }
};

TakenImages all_of(const AccurateImages& made) {
  return {made.images.dirty, made.images.psf, false};
}

bool is_of_psf(const UnlikeSamples& unlike) {
  return !unlike.stokes;
}

bool is_of_second(const UnlikeSamples& unlike) {
  return unlike.stokes == 1U;
}

}  // namespace

BOOST_DATA_TEST_CASE(images_of_the_same_samples_are_taken_as_they_are,
                     bdata::make({1, 2, 5, 48}) * bdata::make({1e-5, 3e-3}) * bdata::make({1, 2, 3}), size, cell_rad, which) {
  const Scene scene(size, size + 3, cell_rad);
  const AccurateImages anew = scene.made();
  TakenImages some = all_of(anew);
  if ((which & 1) == 0) some.dirty.reset();
  if ((which & 2) == 0) some.psf.reset();
  const AccurateImages made = scene.made(some);
  for (std::size_t s = 0; s < 2; ++s) {
    BOOST_TEST(made.images.sums[s].used == anew.images.sums[s].used);
    BOOST_TEST(made.images.sums[s].outside_grid == anew.images.sums[s].outside_grid);
    BOOST_TEST(made.images.sums[s].weight == anew.images.sums[s].weight, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(made.images.dirty_statistics[s].square_sum == anew.images.dirty_statistics[s].square_sum,
               boost::test_tools::tolerance(1e-5));
    BOOST_TEST(relative_error(made.images.dirty[s].pixel, anew.images.dirty[s].pixel) <= (some.dirty ? 0 : 2e-6));
  }
  BOOST_TEST(relative_error(made.images.psf.pixel, anew.images.psf.pixel) <= (some.psf ? 0 : 2e-6));
  BOOST_TEST(made.images.psf_statistics.square_sum == anew.images.psf_statistics.square_sum,
             boost::test_tools::tolerance(1e-5));
}

BOOST_DATA_TEST_CASE(those_of_other_weights_are_refused, bdata::make({1e-5, 3e-3}), cell_rad) {
  Scene scene(48, 32, cell_rad);
  const TakenImages taken = all_of(scene.made());
  for (std::size_t i = 0; i < scene.block.weight.size(); i += 3) scene.block.weight[i] *= 1.3F;
  BOOST_CHECK_EXCEPTION(scene.made(taken), UnlikeSamples, is_of_psf);
}

BOOST_AUTO_TEST_CASE(those_of_other_data_are_refused_but_not_those_of_a_model) {
  Scene scene(48, 32, 1e-5);
  TakenImages taken = all_of(scene.made());
  for (std::size_t i = scene.block.samples(); i < scene.block.visibility.size(); ++i) scene.block.visibility[i] *= 1.02F;
  BOOST_CHECK_EXCEPTION(scene.made(taken), UnlikeSamples, is_of_second);
  taken.of_model = true;
  BOOST_TEST((scene.made(taken).images.dirty[1].pixel == (*taken.dirty)[1].pixel));
}

/// Without w the PSF says what a model leaves, wherever its components lie.
BOOST_AUTO_TEST_CASE(a_residual_is_known_to_be_that_of_its_model) {
  Scene scene(48, 32, 1e-5);
  scene.request.gridder = Gridder::standard;
  scene.request.psf_accuracy = 1e-4;
  for (std::size_t row = 0; row < scene.block.rows(); ++row) scene.block.uvw_m.edit()[3 * row + 2] = 0;
  const AccurateImages made = scene.made();
  Image model(48, 32);
  for (const auto& [row, column, jy] : {std::tuple{0, 0, 1.0}, {31, 47, -2.0}, {16, 24, 0.5}, {3, 30, 1.5}})
    model.at(row, column) = jy;
  const StoredVisibilities samples = stored({scene.block});
  for (std::size_t s = 0; s < 2; ++s) {
    const ImagedData imaged{{samples, s}, *made.transform, made.images.normalisation};
    const Image residual = make_residual_image(imaged, model, {});
    TakenImages taken{made.images.dirty, std::nullopt, true};
    (*taken.dirty)[s] = residual;
    const AccurateImages begun = scene.made(taken);
    const auto check = [&](const Image& of) {
      require_residual_of({{&of}, {&begun.images.psf}, begun.dirty_middles.at(s)}, scene.request, s, begun.images.dirty[s]);
    };
    BOOST_CHECK_NO_THROW(check(model));
    Image other = model;
    other.at(3, 30) += 1;
    BOOST_CHECK_THROW(check(other), UnlikeSamples);
    BOOST_CHECK_THROW(check(Image(48, 32)), UnlikeSamples);
  }
}

BOOST_AUTO_TEST_CASE(what_is_no_number_is_refused) {
  const Scene scene(48, 32, 1e-5);
  TakenImages taken = all_of(scene.made());
  taken.psf->at(16, 24) = NAN;
  BOOST_CHECK_EXCEPTION(scene.made(taken), UnlikeSamples, is_of_psf);
}

BOOST_AUTO_TEST_SUITE_END()
