#include "tools/run/image_options.h"

#include <CLI/CLI.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "tools/run/beam_choice.h"
#include "tools/run/clean_options.h"
#include "tools/run/gridding_options.h"

BOOST_AUTO_TEST_SUITE(image_options)

namespace {

using namespace misfit::tools;

ImageOptions good() {
  ImageOptions options;
  options.vis = {"a.ms"};
  options.imagename = "a";
  options.imsize = {64};
  options.cell = "1arcsec";
  return options;
}

bool is_refused(const std::function<void(ImageOptions&)>& change) {
  ImageOptions options = good();
  change(options);
  try {
    check(options);
  } catch (const std::invalid_argument&) {
    return true;
  }
  return false;
}

}  // namespace

BOOST_AUTO_TEST_CASE(limits_belong_to_what_is_allowed) {
  BOOST_TEST(!is_refused([](ImageOptions&) {}));
  BOOST_TEST(!is_refused([](ImageOptions& o) { o.imsize = {1, 65536}; }));
  BOOST_TEST(!is_refused([](ImageOptions& o) { o.clean.gain = 1; }));
  BOOST_TEST(!is_refused([](ImageOptions& o) { o.clean.nmajor = -1; }));
  BOOST_TEST(!is_refused([](ImageOptions& o) { o.clean.minpsffraction = o.clean.maxpsffraction = 1; }));
  BOOST_TEST(is_refused([](ImageOptions& o) { o.imsize = {65537, 1}; }));
  BOOST_TEST(is_refused([](ImageOptions& o) { o.imsize = {64, 0}; }));
  BOOST_TEST(is_refused([](ImageOptions& o) { o.clean.gain = 1.0001; }));
  BOOST_TEST(is_refused([](ImageOptions& o) { o.clean.nmajor = -2; }));
  BOOST_TEST(is_refused([](ImageOptions& o) { o.clean.maxpsffraction = 0.01; }));
  BOOST_TEST(is_refused([](ImageOptions& o) { o.clean.minpsffraction = 0; }));
}

BOOST_AUTO_TEST_CASE(options_of_clean_need_what_gives_them_meaning) {
  const auto cleaning = [](const std::function<void(ImageOptions&)>& change) {
    return is_refused([&](ImageOptions& o) { o.clean.niter = 10, change(o); });
  };
  BOOST_TEST(!cleaning([](ImageOptions& o) { o.clean.deconvolver = "multiscale", o.clean.scales = {0, 5, 15}; }));
  BOOST_TEST(cleaning([](ImageOptions& o) { o.clean.deconvolver = "multiscale"; }));
  BOOST_TEST(cleaning([](ImageOptions& o) { o.clean.scales = {0, 5}; }));
  BOOST_TEST(cleaning([](ImageOptions& o) { o.clean.deconvolver = "multiscale", o.clean.scales = {5, 0}; }));
  BOOST_TEST(cleaning([](ImageOptions& o) { o.clean.deconvolver = "multiscale", o.clean.scales = {0, 65}; }));
  BOOST_TEST(
      cleaning([](ImageOptions& o) { o.clean.deconvolver = "multiscale", o.clean.scales = {0}, o.clean.smallscalebias = 1; }));
  BOOST_TEST(!cleaning([](ImageOptions& o) { o.clean.usemask = "auto"; }));
  BOOST_TEST(is_refused([](ImageOptions& o) { o.clean.usemask = "auto"; }));
  BOOST_TEST(cleaning([](ImageOptions& o) { o.clean.usemask = "auto", o.clean.mask = {"m.fits"}; }));
  BOOST_TEST(cleaning([](ImageOptions& o) { o.clean.usemask = "auto", o.clean.lownoisethreshold = 6; }));
  BOOST_TEST(is_refused([](ImageOptions& o) { o.clean.restart = true; }));
  BOOST_TEST(cleaning([](ImageOptions& o) { o.imsize = {64, 2}; }));
  BOOST_TEST(!cleaning([](ImageOptions& o) { o.imsize = {1}, o.clean.restoringbeam = "1arcsec"; }));
}

BOOST_AUTO_TEST_CASE(components_are_points_where_no_scales_are_asked) {
  BOOST_TEST(deconvolver_choice(good().clean, 1).scale_pixels == std::vector<double>{0}, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(scales_are_as_wide_at_half_maximum_as_tcleans) {
  ImageOptions options = good();
  options.clean.deconvolver = "multiscale";
  options.clean.scales = {0, 10};
  const std::vector<double> scales = deconvolver_choice(options.clean, 1).scale_pixels;
  // tclean's kernel is (1 − r²) ψ(r), r = distance / scale, with ψ of Schwab (1984, in Indirect Imaging), m = 6, α = 1: on
  // r ≤ 0.75 his ψ(r) = Σ P_k (r² − 0.75²)^k / Σ Q_k (r² − 0.75²)^k.
  const auto kernel = [](double r) {
    const double d = r * r - 0.75 * 0.75;
    const double p = 8.203343e-2 + d * (-3.644705e-1 + d * (6.278660e-1 + d * (-5.335581e-1 + d * 2.312756e-1)));
    return (1 - r * r) * p / (1 + d * (8.212018e-1 + d * 2.078043e-1));
  };
  BOOST_TEST(scales.front() == 0);
  BOOST_TEST(std::abs(kernel(scales.back() / 10 / 2) - kernel(0) / 2) < 1e-4);  // the factor has four digits
}

BOOST_AUTO_TEST_CASE(no_accuracy_is_asked_only_where_width_and_padding_are) {
  BOOST_TEST(is_refused([](ImageOptions& o) { o.gridding.accuracy = 0; }));
  BOOST_TEST(is_refused([](ImageOptions& o) { o.gridding.accuracy = 0, o.gridding.kernel_width = 5; }));
  BOOST_TEST(
      !is_refused([](ImageOptions& o) { o.gridding.accuracy = 0, o.gridding.kernel_width = 5, o.gridding.padding = 1.5; }));
  BOOST_TEST(is_refused([](ImageOptions& o) { o.gridding.accuracy = std::nan(""); }));
}

BOOST_AUTO_TEST_CASE(one_size_is_a_square_and_two_are_width_and_height) {
  ImageOptions options = good();
  BOOST_TEST(geometry_of(options, {}).width == 64);
  BOOST_TEST(geometry_of(options, {}).height == 64);
  options.imsize = {64, 48};
  BOOST_TEST(geometry_of(options, {}).width == 64);
  BOOST_TEST(geometry_of(options, {}).height == 48);
}

BOOST_AUTO_TEST_CASE(clean_gets_every_option_that_is_its_own) {
  ImageOptions options = good();
  options.clean.niter = 7;
  options.clean.gain = 0.25;
  options.clean.threshold = "3mJy";
  options.clean.nsigma = 4;
  options.clean.cyclefactor = 1.5;
  options.clean.minpsffraction = 0.1;
  options.clean.maxpsffraction = 0.7;
  options.clean.nmajor = 9;
  const misfit::imager::CleanOptions clean = clean_options(options.clean, 3);
  BOOST_TEST(clean.max_iterations == 7);
  BOOST_TEST(clean.gain == 0.25);
  BOOST_TEST(clean.threshold_jy == 3e-3);
  BOOST_TEST(clean.nsigma == 4);
  BOOST_TEST(clean.cycle_factor == 1.5);
  BOOST_TEST(clean.min_psf_fraction == 0.1);
  BOOST_TEST(clean.max_psf_fraction == 0.7);
  BOOST_TEST(clean.max_major_cycles == 9);
  BOOST_TEST(clean.threads == 3);
}

BOOST_AUTO_TEST_CASE(values_in_force_are_those_typed_or_the_defaults) {
  CLI::App app;
  app.option_defaults()->always_capture_default();
  ImageOptions options;
  declare(app, options);
  app.parse("--vis a.ms --imagename a --imsize 64 32 --cell 1arcsec --quiet");
  const nlohmann::json values = option_values(app);
  BOOST_TEST(values.at("imsize") == "64 32");
  BOOST_TEST(values.at("gain") == "0.1");
  BOOST_TEST(values.at("quiet") == "true");
  BOOST_TEST(!values.contains("help"));
}

/// As other imagers call them.
BOOST_AUTO_TEST_CASE(options_and_values_have_other_names) {
  CLI::App app;
  app.option_defaults()->always_capture_default();
  ImageOptions options;
  declare(app, options);
  app.parse(
      "--vis a.ms --imagename a --imsize 64 --cell 1arcsec --width 2 --gridder wproject --usemask auto-multithresh "
      "--deconvolver mtmfs");
  settle_mtmfs(app, options);
  BOOST_TEST(options.cube.chanwidth == "2");
  BOOST_TEST(options.gridding.gridder == "wide");
  BOOST_TEST(options.clean.usemask == "auto");
  BOOST_TEST(options.clean.deconvolver == "hogbom");
  BOOST_TEST(options.taylor.nterms == 2);
  const nlohmann::json values = option_values(app);  // by ours, so that runs can be compared
  BOOST_TEST(values.at("chanwidth") == "2");
  BOOST_TEST(values.at("gridder") == "wide");
  BOOST_TEST(values.at("usemask") == "auto");
  BOOST_TEST(values.at("nterms") == "2");
}

BOOST_AUTO_TEST_CASE(mtmfs_is_multiscale_where_there_are_scales_and_keeps_terms_that_are_given) {
  CLI::App app;
  ImageOptions options;
  declare(app, options);
  app.parse("--vis a.ms --imagename a --imsize 64 --cell 1arcsec --deconvolver mtmfs --scales 0,5 --nterms 3");
  settle_mtmfs(app, options);
  BOOST_TEST(options.clean.deconvolver == "multiscale");
  BOOST_TEST(options.taylor.nterms == 3);
}

BOOST_AUTO_TEST_CASE(states_belong_to_options_that_reach_clean) {
  CLI::App app;
  app.option_defaults()->always_capture_default();
  ImageOptions options;
  declare(app, options);
  app.parse("--vis a.ms --imagename a --imsize 64 32 --cell 1arcsec --niter 7");
  const auto [values, ways] = state_option_values(app);
  for (const char* name : {"vis", "imsize", "nterms", "weighting", "stokes"}) BOOST_TEST(values.contains(name), name);
  for (const char* name : {"gain", "mask", "usemask", "deconvolver", "scales", "cyclefactor"})
    BOOST_TEST((ways.contains(name) && !values.contains(name)), name);
  BOOST_TEST(ways.size() == 22U);
  for (const char* name :
       {"niter", "threshold", "nsigma", "nmajor", "savemodel", "restoringbeam", "verify", "check-outside", "threads", "memory",
        "quiet", "outformat", "restart", "imagename", "pbcor", "pblimit", "kernel-folder"})
    BOOST_TEST(!values.contains(name), name);
}

/// An option that changes no image is marked free_of_state, and is not here: a run that goes on may have another.
BOOST_AUTO_TEST_CASE(states_are_refused_for_options_that_change_images_alone) {
  CLI::App app;
  app.option_defaults()->always_capture_default();
  ImageOptions options;
  declare(app, options);
  app.parse("--vis a.ms --imagename a --imsize 64 32 --cell 1arcsec --niter 7");
  const StateOptionValues values = state_option_values(app);
  std::string names;
  for (const auto& [name, value] : values.owners.items()) names += name + " ";
  BOOST_TEST(names ==
             "accuracy antenna beam-cut calcpsf calcres cell chanwidth datacolumn evaluation field gridder imsize intent "
             "interpolation kernel kernel-width maxuv-l minuv-l mosweight nchan noise normtype npixels nterms observation "
             "outframe padding perchanweightdensity phasecenter precision psf-accuracy psfphasecenter reffreq restfreq robust "
             "sampling scan specmode spw start startmodel stokes taper-inner-tukey taper-tukey timerange usepointing uvrange "
             "uvtaper veltype vis weighting weighting-rank-filter weighting-rank-filter-size ");
}

BOOST_AUTO_TEST_CASE(pixels_may_have_two_sides_that_are_equal) {
  const auto cell = [](const std::string& sides) {
    CLI::App app;
    app.option_defaults()->always_capture_default();
    ImageOptions options;
    declare(app, options);
    app.parse("--vis a.ms --imagename a --imsize 64 32 --cell " + sides);
    return options.cell + " of " + option_values(app).at("cell").get<std::string>();
  };
  BOOST_TEST(cell("0.2arcsec") == "0.2arcsec of 0.2arcsec");
  BOOST_TEST(cell("0.2arcsec 0.2arcsec") == "0.2arcsec of 0.2arcsec 0.2arcsec");
  BOOST_TEST(cell("200mas 0.2") == "200mas of 200mas 0.2");
  BOOST_CHECK_EXCEPTION(cell("0.2arcsec 0.3arcsec"), std::invalid_argument, [](const std::exception& error) {
    return std::string(error.what()).starts_with("--cell 0.2arcsec 0.3arcsec: expected one size, or two that are equal");
  });
}

BOOST_AUTO_TEST_SUITE_END()
