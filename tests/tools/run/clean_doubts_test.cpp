#include "tools/run/clean_doubts.h"

#include <boost/test/unit_test.hpp>

BOOST_AUTO_TEST_SUITE(clean_doubts)

using namespace misfit;
using imager::CleanReport;
using imager::CleanStop;
using tools::CleanedImage;
using tools::TypedClean;

namespace {

/// A run of five cycles, of which the third and the fourth were taken back.
CleanReport report() {
  CleanReport report;
  report.stop = CleanStop::nsigma;
  report.max_sidelobe = 0.332;
  report.cycles.resize(6);
  report.cycles[2].from = 1;
  report.cycles[3].from = report.cycles[4].from = report.cycles[5].from = 2;
  report.kept = 5;
  return report;
}

/// A run of as many cycles, none of which was taken back.
CleanReport calm_report() {
  CleanReport calm = report();
  for (std::size_t cycle = 1; cycle < calm.cycles.size(); ++cycle) calm.cycles[cycle].from = cycle - 1;
  return calm;
}

/// A run whose automatic mask was empty at first: the peak is 106 Jy/beam and the noise 1.6.
CleanReport empty_report() {
  CleanReport empty;
  empty.stop = CleanStop::empty_mask;
  empty.max_sidelobe = 0.332;
  empty.cycles.resize(1);
  empty.cycles.front().peak_residual_jy = 106;
  empty.cycles.front().rms_jy = 1.6;
  empty.cycles.front().masked = {.threshold_jy = 3 * 0.332 * 106, .by_sidelobes = true, .regions = 1, .pruned = 1};
  return empty;
}

std::string doubts_of(const CleanReport& report, const TypedClean& options = {}, const CleanedImage& image = {0, 2639}) {
  std::string all;
  for (const std::string& doubt : tools::clean_doubts(report, options, image)) all += doubt + "\n";
  return all;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

BOOST_AUTO_TEST_CASE(nothing_is_doubtful_about_a_clean_that_ended_well) {
  BOOST_TEST(doubts_of(calm_report(), {}, {2639, 2639}) == "");
}

BOOST_AUTO_TEST_CASE(more_components_than_visibilities_fit_noise) {
  TypedClean options;
  BOOST_TEST(doubts_of(calm_report(), options, {3024, 2639}) ==
             "CLEAN found 3\u2009024 distinct components in 2\u2009639 visibilities, more than these determine: it fits noise, "
             "and the noise found is too low; expected a --mask around the sources, --usemask auto or a larger --nsigma\n");
  options.usemask = "auto";
  BOOST_TEST(has(doubts_of(calm_report(), options, {3024, 2639}), "expected a smaller mask or a larger --nsigma"));
  options.startmodel = {"of_another.model.fits"};  // its pixels were not found here
  BOOST_TEST(doubts_of(calm_report(), options, {3024, 2639}) == "");
}

BOOST_AUTO_TEST_CASE(cycles_that_were_taken_back_are_counted) {
  BOOST_TEST(has(doubts_of(report()), "the residual grew in 2 of 5 major cycles, which were taken back: a lower --gain"));
}

BOOST_AUTO_TEST_CASE(coarser_transforms_that_mislead_are_no_fault_of_clean) {
  CleanReport misled = report();
  misled.cycles[3].accuracy = misled.cycles[4].accuracy = 1e-3;
  BOOST_TEST(doubts_of(misled) == "");
}

BOOST_AUTO_TEST_CASE(divergence_is_told_once) {
  CleanReport diverged = report();
  diverged.stop = CleanStop::diverging_from_best;
  BOOST_TEST(doubts_of(diverged) ==
             "CLEAN diverged: a lower --gain, a --mask around the sources, or more scales may help; the largest sidelobe is 33 "
             "% of the PSF's peak\n");
}

BOOST_AUTO_TEST_CASE(an_automatic_mask_that_stays_empty_beside_a_source_names_what_governs) {
  BOOST_TEST(doubts_of(empty_report()) ==
             "the automatic mask is empty, and nothing is cleaned: it takes regions of --minbeamfrac 0.3 of the beam or more "
             "above 105.6 Jy/beam, --sidelobethreshold 3 "
             "times the PSF's largest sidelobe 0.332 times the peak; expected a lower --sidelobethreshold, such as 1.5\n");
  CleanReport by_noise = empty_report();
  by_noise.cycles.front().masked = {.threshold_jy = 160, .by_sidelobes = false, .regions = 0, .pruned = 0};
  TypedClean options;
  options.noisethreshold = 100;
  BOOST_TEST(has(doubts_of(by_noise, options), "160 Jy/beam, --noisethreshold 100 times the noise; expected a lower"));
  by_noise.cycles.front().masked = {.threshold_jy = 8, .by_sidelobes = false, .regions = 2, .pruned = 2};
  BOOST_TEST(has(doubts_of(by_noise), "expected a smaller --minbeamfrac"));
  by_noise.cycles.front().masked = {.threshold_jy = 8, .by_sidelobes = false, .regions = 0, .pruned = 0};
  BOOST_TEST(has(doubts_of(by_noise), "expected a --negativethreshold, since the brightest pixel is negative"));
  CleanReport by_sidelobes = empty_report();
  options.sidelobethreshold = 1;
  by_sidelobes.cycles.front().masked = {.threshold_jy = 0.332 * 106, .by_sidelobes = true, .regions = 3, .pruned = 3};
  BOOST_TEST(has(doubts_of(by_sidelobes, options), "expected a smaller --minbeamfrac"));
  by_sidelobes.cycles.front().masked.regions = by_sidelobes.cycles.front().masked.pruned = 0;
  BOOST_TEST(has(doubts_of(by_sidelobes, options), "expected a --negativethreshold"));
}

BOOST_AUTO_TEST_CASE(a_mask_is_rightly_empty_where_there_is_noise_or_no_source_within_its_limits) {
  CleanReport noise = empty_report();
  noise.cycles.front().peak_residual_jy = 5 * 1.6;
  noise.cycles.front().masked.threshold_jy = 3 * 0.332 * 5 * 1.6;
  BOOST_TEST(doubts_of(noise) == "");
  CleanReport elsewhere = empty_report();
  elsewhere.cycles.front().masked = {.threshold_jy = 8, .by_sidelobes = false, .regions = 0, .pruned = 0};
  BOOST_TEST(doubts_of(elsewhere, {}, {.limited = true}) == "");
  CleanReport given = empty_report();
  given.cycles.front().masked = {};  // a mask of the user's
  BOOST_TEST(doubts_of(given) == "");
}

BOOST_AUTO_TEST_CASE(planes_have_doubts_in_the_same_words) {
  const CleanedImage a{.components = 30, .visibilities = 20, .one_of_many = true};
  const CleanedImage b{.components = 55, .visibilities = 50, .one_of_many = true};
  for (const auto& of : {report, empty_report}) {
    CleanReport other = of();
    other.max_sidelobe = 0.4;
    other.cycles.front().masked.threshold_jy *= 0.4 / 0.332;
    BOOST_TEST(doubts_of(of(), {}, a) == doubts_of(other, {}, b));
    BOOST_TEST(has(doubts_of(of(), {}, a), "more distinct components than there are visibilities"));
  }
}

BOOST_AUTO_TEST_SUITE_END()
