#include "imager/arrays/array_clean.h"

#include <boost/test/unit_test.hpp>
#include <limits>

#include "imager/data/image_statistics.h"
#include "tests/imager/arrays/array_scene.h"
#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(array_clean)

using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr int row_of_source = 70, column_of_source = 40;
constexpr double flux_jy = 2.5;

/// A point off the middle, seen with a beam that is longest along x = y.
ArrayScene<double> point_scene() {
  const double pixel = 1e-5;
  ArrayScene<double> scene({96, 120, pixel, pixel, 0, 0}, 1500, 2, 0.4);
  for (std::size_t row = 0; row < scene.rows(); ++row) {
    const double along = scene.uvw_m[3 * row] / 3, across = scene.uvw_m[3 * row + 1];
    scene.uvw_m[3 * row] = (along + across) * std::sqrt(0.5);
    scene.uvw_m[3 * row + 1] = (along - across) * std::sqrt(0.5);
  }
  std::vector<double> model(std::size_t{96} * 120);
  model[row_of_source * 120 + column_of_source] = flux_jy;
  scene.visibility = direct_visibilities(scene.image, scene.at(), model, false);
  return scene;
}

ArrayCleanOptions options_of(const ArrayScene<double>& scene) {
  ArrayCleanOptions options;
  options.transform = scene.options(1e-6);
  options.clean.max_iterations = 500;
  options.clean.threshold_jy = 1e-4;
  return options;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_point_comes_back_where_it_was_with_its_flux) {
  const ArrayScene<double> scene = point_scene();
  const ArrayCoordinates at = scene.at();
  const ArrayClean cleaned = clean_arrays(options_of(scene), at, scene.values());
  BOOST_TEST(static_cast<int>(cleaned.report.stop) == static_cast<int>(CleanStop::threshold));
  const Peak peak = find_peak(cleaned.restored);
  BOOST_TEST(peak.row == row_of_source);
  BOOST_TEST(peak.column == column_of_source);
  const double left = 1.01e-4;  // the threshold, in the residual and not yet in the model
  BOOST_TEST(std::abs(peak.value - flux_jy) < 2 * left);
  BOOST_TEST(std::abs(cleaned.model.at(row_of_source, column_of_source) - flux_jy) < 2 * left);
  BOOST_TEST(largest_magnitude(cleaned.residual) < left);
  BOOST_TEST(std::abs(cleaned.psf.at(48, 60) - 1) < 1e-6);
}

BOOST_AUTO_TEST_CASE(the_beam_turns_from_x_towards_y) {
  const ArrayScene<double> scene = point_scene();
  const ArrayCoordinates at = scene.at();
  const ArrayClean cleaned = clean_arrays(options_of(scene), at, scene.values());
  // u + v reaches a third as far as u − v: the beam is three times as long along x = y as across, at 45°.
  BOOST_TEST(std::abs(cleaned.beam.position_angle_rad - pi / 4) < 0.05);
  BOOST_TEST(cleaned.beam.major_rad > 2 * cleaned.beam.minor_rad);
  const double along = cleaned.psf.at(48 + 2, 60 + 2), across = cleaned.psf.at(48 + 2, 60 - 2);
  BOOST_TEST(along > across);
}

BOOST_AUTO_TEST_CASE(a_start_model_that_is_the_sky_leaves_nothing_to_find) {
  const ArrayScene<double> scene = point_scene();
  const ArrayCoordinates at = scene.at();
  std::vector<double> model(std::size_t{96} * 120);
  model[row_of_source * 120 + column_of_source] = flux_jy;
  ArrayCleanOptions options = options_of(scene);
  options.start_model = {model.data(), 96, 120, 120};
  const ArrayClean cleaned = clean_arrays(options, at, scene.values());
  BOOST_TEST(cleaned.report.iterations == 0);
  BOOST_TEST(cleaned.model.at(row_of_source, column_of_source) == flux_jy);
}

BOOST_AUTO_TEST_CASE(the_user_s_wish_ends_it) {
  const ArrayScene<double> scene = point_scene();
  const ArrayCoordinates at = scene.at();
  ArrayCleanOptions options = options_of(scene);
  options.clean.stop_requested = [] { return true; };
  const ArrayClean cleaned = clean_arrays(options, at, scene.values());
  BOOST_TEST(static_cast<int>(cleaned.report.stop) == static_cast<int>(CleanStop::user));
}

BOOST_AUTO_TEST_CASE(weights_and_masks_choose_the_data) {
  ArrayScene<double> scene = point_scene();
  for (std::size_t i = 0; i < scene.visibility.size(); ++i) {
    if (scene.mask[i] == 0) scene.visibility[i] = std::numeric_limits<double>::quiet_NaN();
    if (i % 5 == 1 && scene.mask[i] != 0) {
      scene.weight[i] = 0;
      scene.visibility[i] = 1e6;
    }
  }
  const ArrayCoordinates at = scene.at();
  const ArrayClean cleaned = clean_arrays(options_of(scene), at, scene.values());
  BOOST_TEST(std::abs(find_peak(cleaned.restored).value - flux_jy) < 1e-3);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_cleaned_is_refused) {
  const ArrayScene<double> scene = point_scene();
  const ArrayCoordinates at = scene.at();
  ArrayScene<double> bad = scene;
  bad.weight[1] = -1;
  BOOST_CHECK_THROW(clean_arrays(options_of(scene), at, bad.values()), std::invalid_argument);
  bad = scene;
  bad.visibility[1] = std::numeric_limits<double>::infinity();
  BOOST_CHECK_THROW(clean_arrays(options_of(scene), at, bad.values()), std::invalid_argument);
  ArrayCleanOptions oblong = options_of(scene);
  oblong.transform.image.pixel_y_rad *= 2;
  BOOST_CHECK_THROW(clean_arrays(oblong, at, scene.values()), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
