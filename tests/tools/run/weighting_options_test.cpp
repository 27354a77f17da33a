#include "tools/run/weighting_options.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>
#include <numbers>

BOOST_AUTO_TEST_SUITE(weighting_options)

namespace {

using namespace misfit;
using namespace misfit::tools;

std::string refusal(const std::function<void(TypedWeighting&)>& change) {
  TypedWeighting options;
  change(options);
  try {
    check(options, CubeOptions());
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

imager::UvTaper taper(const std::string& text) {
  TypedWeighting options;
  options.uvtaper = text;
  check(options, CubeOptions());
  return misfit::tools::weighting_options(options).taper.value();
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_option_without_effect_or_out_of_range_is_refused_by_name) {
  BOOST_TEST(refusal([](TypedWeighting&) {}) == "");
  BOOST_TEST(refusal([](TypedWeighting& o) { o.scheme = "briggs", o.robust = -2; }) == "");
  BOOST_TEST(refusal([](TypedWeighting& o) { o.scheme = "superuniform", o.npixels = 4; }) == "");
  BOOST_TEST(refusal([](TypedWeighting& o) { o.scheme = "uniform", o.uvtaper = "3klambda"; }) == "");
  BOOST_TEST(refusal([](TypedWeighting& o) { o.robust = 1; }) == "--robust 1: expected --weighting briggs beside it");
  BOOST_TEST(refusal([](TypedWeighting& o) { o.scheme = "briggs", o.robust = 2.5; }) == "--robust 2.5: expected -2 to 2");
  BOOST_TEST(refusal([](TypedWeighting& o) { o.scheme = "uniform", o.npixels = 4; }) ==
             "--npixels 4: expected --weighting superuniform beside it");
  BOOST_TEST(refusal([](TypedWeighting& o) { o.scheme = "superuniform", o.npixels = -1; }) ==
             "--npixels -1: expected 2 to 200 cells, or 0 (6)");
  for (const char* wrong : {"5arcsec,", "-1arcsec", "5arcsec,3klambda", "5arcsec,4arcsec,30", "1,2,3deg,4", "5parsec"})
    BOOST_TEST(refusal([&](TypedWeighting& o) {
                 o.uvtaper = wrong;
               }).starts_with("--uvtaper " + std::string(wrong) + ": expected MAJ, MAJ,MIN or MAJ,MIN,PA"));
}

BOOST_AUTO_TEST_CASE(a_taper_is_one_to_three_values_of_the_sky_or_of_the_uv_plane) {
  constexpr double arcsec = std::numbers::pi / 180 / 3600;
  const imager::UvTaper sky = taper("5arcsec, 4arcsec, 90deg"), plane = taper("2klambda,3000lambda"), round = taper("5");
  const imager::UvTaper expected = imager::taper_of_beam({5 * arcsec, 4 * arcsec, std::numbers::pi / 2});
  BOOST_TEST(sky.along == expected.along);
  BOOST_TEST(sky.across == expected.across);
  BOOST_TEST(sky.position_angle_rad == std::numbers::pi / 2);
  BOOST_TEST(round.along == expected.along);
  BOOST_TEST(round.across == round.along);
  // North is v: half at 2 kλ along it, and at 3 kλ along u.
  BOOST_TEST(std::abs(imager::taper_exponent_m2(plane, 0, 2000) / std::log(2) - 1) < 1e-14);
  BOOST_TEST(std::abs(imager::taper_exponent_m2(plane, 3000, 0) / std::log(2) - 1) < 1e-14);
}

BOOST_AUTO_TEST_CASE(arguments_are_what_the_options_say) {
  TypedWeighting options;
  options.scheme = "briggs";
  options.robust = -0.5;
  options.uvtaper = "5arcsec";
  const std::vector<std::string> expected{"--weighting", "briggs", "--robust", "-0.5", "--uvtaper", "5arcsec"};
  BOOST_CHECK(weighting_arguments(options) == expected);
  BOOST_TEST(weighting_text(options) == "Briggs, robust -0.5, tapered by 5arcsec");
}

BOOST_AUTO_TEST_SUITE_END()
