#include "tools/run/weighting_options.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "tests/imager/random_samples.h"

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
  for (const char* density : {"uniform", "superuniform", "briggs", "briggsabs"})
    BOOST_TEST(refusal([&](TypedWeighting& o) { o.scheme = density, o.rank_filter = 3, o.rank_filter_size = 128; }) == "");
  const std::string by_density = "expected --weighting uniform, superuniform, briggs or briggsabs beside it";
  BOOST_TEST(refusal([](TypedWeighting& o) { o.rank_filter = 3; }) == "--weighting-rank-filter 3: " + by_density);
  BOOST_TEST(refusal([](TypedWeighting& o) { o.scheme = "uniform", o.rank_filter = -1; }) ==
             "--weighting-rank-filter -1: expected a number above 0, such as 3, or 0 (none)");
  BOOST_TEST(refusal([](TypedWeighting& o) { o.scheme = "uniform", o.rank_filter_size = 8; }) ==
             "--weighting-rank-filter-size 8: expected --weighting-rank-filter beside it");
  BOOST_TEST(refusal([](TypedWeighting& o) { o.scheme = "uniform", o.rank_filter = 3, o.rank_filter_size = 1; }) ==
             "--weighting-rank-filter-size 1: expected 2 to 200 cells");
  for (const char* wrong : {"5arcsec,", "-1arcsec", "5arcsec,3klambda", "5arcsec,4arcsec,30", "1,2,3deg,4", "5parsec"})
    BOOST_TEST(refusal([&](TypedWeighting& o) {
                 o.uvtaper = wrong;
               }).starts_with("--uvtaper " + std::string(wrong) + ": expected MAJ, MAJ,MIN or MAJ,MIN,PA"));
}

BOOST_AUTO_TEST_CASE(a_bandwidth_taper_takes_no_rank_filter) {
  TypedWeighting options;
  options.scheme = "briggsbwtaper";
  options.rank_filter = 3;
  CubeOptions cube;
  cube.specmode = "cube";
  BOOST_CHECK_THROW(check(options, cube), std::invalid_argument);
  options.rank_filter = 0;
  BOOST_CHECK_NO_THROW(check(options, cube));
}

BOOST_AUTO_TEST_CASE(limits_in_the_uv_plane_that_mean_nothing_are_refused_by_name) {
  BOOST_TEST(refusal([](TypedWeighting& o) { o.minuv_l = "80", o.maxuv_l = "7klambda", o.taper_tukey = "1e3"; }) == "");
  BOOST_TEST(refusal([](TypedWeighting& o) { o.taper_inner_tukey = "1klambda"; }) == "");
  for (const char* wrong : {"0", "-1", "5arcsec", "3 klambda,4", "nan", "1e400"}) {
    const std::string value = wrong;
    BOOST_TEST(refusal([&](TypedWeighting& o) {
                 o.minuv_l = value;
               }).starts_with("--minuv-l " + value + ": expected more than 0 wavelengths, such as"));
    BOOST_TEST(refusal([&](TypedWeighting& o) {
                 o.maxuv_l = value;
               }).starts_with("--maxuv-l " + value + ": expected more than 0 wavelengths, such as"));
    BOOST_TEST(refusal([&](TypedWeighting& o) {
                 o.maxuv_l = "9", o.taper_tukey = value;
               }).starts_with("--taper-tukey " + value + ": expected more than 0 wavelengths, such as"));
    BOOST_TEST(refusal([&](TypedWeighting& o) {
                 o.taper_inner_tukey = value;
               }).starts_with("--taper-inner-tukey " + value + ": expected more than 0 wavelengths, such as"));
  }
  BOOST_TEST(refusal([](TypedWeighting& o) { o.taper_tukey = "1klambda"; }) ==
             "--taper-tukey 1klambda: expected --maxuv-l beside it, where the taper ends");
  BOOST_TEST(refusal([](TypedWeighting& o) { o.minuv_l = "3klambda", o.maxuv_l = "3000"; }) ==
             "--minuv-l 3klambda: expected less than --maxuv-l 3000");
}

BOOST_AUTO_TEST_CASE(limits_and_a_rank_filter_reach_the_imager_in_its_units) {
  TypedWeighting typed;
  typed.scheme = "uniform";
  typed.minuv_l = "80";
  typed.maxuv_l = "7klambda";
  typed.taper_tukey = "1000lambda";
  typed.taper_inner_tukey = "0.05 klambda";
  typed.rank_filter = 2.5;
  typed.rank_filter_size = 9;
  const imager::WeightingOptions options = misfit::tools::weighting_options(typed);
  BOOST_TEST(options.window.min_lambda == 80);
  BOOST_TEST(options.window.max_lambda == 7000);
  BOOST_TEST(options.window.outer_edge_lambda == 1000);
  BOOST_TEST(options.window.inner_edge_lambda == 50);
  BOOST_TEST(options.rank_filter.value().level == 2.5);
  BOOST_TEST(options.rank_filter.value().reach == 4);
  BOOST_TEST(misfit::tools::weighting_options(TypedWeighting()).none());
}

BOOST_AUTO_TEST_CASE(pointings_of_a_mosaic_have_their_own_density_unless_mosweight_is_false) {
  const imager::ImageGeometry geometry{64, 64, 1e-5, {}};
  const auto because = [&](const TypedWeighting& o, std::size_t pointings) {
    return weighting_decision(o, geometry, pointings).because;
  };
  TypedWeighting typed;
  typed.scheme = "briggs";
  const std::string one = because(typed, 1);
  BOOST_TEST(misfit::tools::weighting_options(typed).pointings == 1U);
  BOOST_TEST(misfit::tools::weighting_options(typed, 7).pointings == 7U);
  BOOST_TEST(because(typed, 7).find("; each of the 7 pointings has its own density;") != std::string::npos);
  typed.mosweight = false;
  BOOST_CHECK_NO_THROW(check(typed, CubeOptions()));
  BOOST_TEST(misfit::tools::weighting_options(typed, 7).pointings == 1U);
  BOOST_TEST(because(typed, 7).find("; the density is that of all 7 pointings together;") != std::string::npos);
  BOOST_TEST(because(typed, 1) == one);
  BOOST_TEST(one.find("pointing") == std::string::npos);
  const std::vector<std::string> expected{"--weighting", "briggs", "--robust", "0.5", "--mosweight", "false"};
  BOOST_CHECK(weighting_arguments(typed) == expected);
  BOOST_TEST(misfit::tools::weighting_options(TypedWeighting(), 7).pointings == 1U);
  BOOST_TEST(refusal([](TypedWeighting& o) { o.mosweight = false; }) ==
             "--mosweight false: expected weights by density beside it, such as --weighting briggs");
}

BOOST_AUTO_TEST_CASE(weights_of_pointings_are_told_with_the_range_of_f2) {
  const imager::ImageGeometry geometry{64, 64, 1e-5, {}};
  const auto because = [&](std::size_t pointings) {
    imager::UvDensity density(geometry, 1, pointings);
    for (const int field : {0, 1, 1}) {  // the second has the same samples, twice
      imager::VisibilityBlock block = imager::testing::random_samples(1, 1, 1e-5, 1);
      block.weight = {0.5F};
      block.sights = {{0, 1, field, 0}};
      density.add(block);
    }
    imager::WeightingOptions options;
    options.weighting = imager::Weighting::briggs;
    options.robust = 0;
    return weights_decision(imager::ImagingWeights(density, options), imager::WeightSums::of_natural(1)).because;
  };
  // (5 · 10⁰)² / W, where W is that of the only cell.
  BOOST_TEST(because(1).ends_with("; 1 cells of half the uv plane hold samples, f² = 16.67"));
  BOOST_TEST(because(2).ends_with(
      "; 2 cells of half the uv plane hold samples, each counted for every pointing that has samples there, f² from 25 to 50"));
}

BOOST_AUTO_TEST_CASE(a_window_without_samples_is_named_as_it_was_typed) {
  TypedWeighting options;
  options.maxuv_l = "10";
  const imager::WeightSums none{5, 0, 0};
  const auto said = [&](const std::string& of) {
    try {
      require_weight(options, none, 5, of);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string rest = " keeps a weight that counts; expected ";
  const std::string limits = "limits in the uv plane that samples lie well within";
  const std::string taper = "a taper of larger radius in the uv plane, or a smaller angle";
  BOOST_TEST(said("") == "--maxuv-l 10: no sample" + rest + limits);
  BOOST_TEST(said(" of plane 3") == "--maxuv-l 10: no sample of plane 3" + rest + limits);
  options.uvtaper = "5deg";
  BOOST_TEST(said("") == "--uvtaper 5deg --maxuv-l 10: no sample" + rest + limits + ", and " + taper);
  options.maxuv_l = "";
  BOOST_TEST(said("") == "--uvtaper 5deg: no sample" + rest + taper);
  BOOST_CHECK_NO_THROW(require_weight(options, imager::WeightSums::of_natural(5), 5));
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
  options = {};
  options.scheme = "uniform";
  options.rank_filter = 3;
  options.maxuv_l = "7klambda";
  options.taper_tukey = "1000";
  options.taper_inner_tukey = "80lambda";
  const std::vector<std::string> more{
      "--weighting", "uniform",  "--weighting-rank-filter", "3",    "--weighting-rank-filter-size", "16",
      "--maxuv-l",   "7klambda", "--taper-tukey",           "1000", "--taper-inner-tukey",          "80lambda"};
  BOOST_CHECK(weighting_arguments(options) == more);
  BOOST_TEST(weighting_text(options) ==
             "uniform, rank filter 3, from 0lambda with a Tukey edge of 80lambda, up to 7klambda with a Tukey edge of "
             "1000lambda");
}

BOOST_AUTO_TEST_SUITE_END()
