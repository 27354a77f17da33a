#include "tools/run/beam_choice.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <stdexcept>

BOOST_AUTO_TEST_SUITE(beam_choice)

using namespace misfit;
using namespace misfit::tools;

namespace {

constexpr double cell_rad = 1e-6;
const imager::Beam given{7e-6, 5e-6, 0.3};

/// A Gaussian along columns; along rows too where `closed`.
imager::Image psf(bool closed) {
  imager::Image image(48, 48);
  for (int r = 0; r < 48; ++r)
    for (int c = 0; c < 48; ++c) image.at(r, c) = std::exp(-((c - 24) * (c - 24) + (closed ? (r - 24) * (r - 24) : 0)) / 8.0);
  return image;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_fitted_beam_is_taken_and_its_misfit_stated) {
  const BeamChoice choice = choose_beam(psf(true), cell_rad, {}, true);
  BOOST_TEST(choice.how == "fitted");
  BOOST_TEST(std::abs(choice.restoring->major_rad / (std::sqrt(8 * std::log(2.0)) * 2 * cell_rad) - 1) < 1e-9);
  BOOST_TEST(choice.misfit < 1e-9);
  BOOST_TEST(choice.warnings.empty());
}

BOOST_AUTO_TEST_CASE(the_beam_given_wins_and_the_main_lobe_stays_its_own) {
  const BeamChoice choice = choose_beam(psf(true), cell_rad, {.given = given}, true);
  BOOST_TEST(choice.how == "given");
  BOOST_TEST(choice.restoring->major_rad == given.major_rad);
  BOOST_TEST(choice.main_lobe->major_rad < given.major_rad);
  BOOST_TEST(choice.warnings.empty());
}

BOOST_AUTO_TEST_CASE(where_no_ellipse_fits_a_round_beam_is_taken_with_a_warning) {
  const BeamChoice choice = choose_beam(psf(false), cell_rad, {}, true);
  BOOST_TEST(choice.how == "fitted round");
  BOOST_TEST(choice.restoring->major_rad == choice.restoring->minor_rad);
  BOOST_TEST(choice.warnings.size() == 3U);  // no ellipse, a round one, and how badly it fits
}

BOOST_AUTO_TEST_CASE(where_nothing_fits_a_beam_must_be_given) {
  const imager::Image flat(1, 1);
  BOOST_CHECK_EXCEPTION(choose_beam(flat, cell_rad, {}, true), std::runtime_error, [](const std::exception& error) {
    return std::string(error.what()).find("--restoringbeam") != std::string::npos;
  });
  BOOST_TEST(!choose_beam(flat, cell_rad, {}, false).restoring);
  BOOST_TEST(choose_beam(flat, cell_rad, {.given = given}, true).restoring->minor_rad == given.minor_rad);
}

BOOST_AUTO_TEST_CASE(a_circular_beam_is_as_wide_as_the_fitted_one_is_long) {
  imager::Image longer(48, 48);
  for (int r = 0; r < 48; ++r)
    for (int c = 0; c < 48; ++c) longer.at(r, c) = std::exp(-(c - 24) * (c - 24) / 8.0 - (r - 24) * (r - 24) / 18.0);
  const BeamChoice fitted = choose_beam(longer, cell_rad, {}, true);
  const BeamChoice circular = choose_beam(longer, cell_rad, {.circular = true}, true);
  BOOST_TEST(fitted.restoring->minor_rad < 0.7 * fitted.restoring->major_rad);
  BOOST_TEST(circular.restoring->major_rad == fitted.restoring->major_rad);
  BOOST_TEST(circular.restoring->minor_rad == fitted.restoring->major_rad);
  BOOST_TEST(circular.main_lobe->minor_rad == fitted.restoring->minor_rad);
  BOOST_TEST(circular.how == "fitted, made circular");
  BOOST_TEST(circular.misfit > 0.05);
  BOOST_TEST(circular.warnings.empty());
}

BOOST_AUTO_TEST_SUITE_END()
