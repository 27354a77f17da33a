#include "tools/stability/stability_runs.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "imager/files/fits_image.h"
#include "imager/numerics/constants.h"
#include "tests/temporary_folder.h"

BOOST_AUTO_TEST_SUITE(stability_runs)

using namespace misfit;
using namespace misfit::tools;

namespace {

StabilityData few_samples() {
  return made_data(700);
}

/// CLEAN may end for any reason but these.
bool ended_by_itself(imager::CleanStop stop) {
  return stop != imager::CleanStop::user && stop != imager::CleanStop::empty_mask;
}

void check(const std::vector<StabilityOutcome>& outcomes) {
  for (const StabilityOutcome& o : outcomes)
    BOOST_TEST_CONTEXT(o.name << " at " << o.accuracy << ": measured " << o.measured.rms << ", prediction "
                              << o.measured.predict_rms << ", worst pixel " << o.measured.max) {
      BOOST_TEST_REQUIRE(o.finite);
      BOOST_TEST(o.honest());
      BOOST_TEST(o.within_bounds());
      BOOST_TEST(ended_by_itself(o.clean.stop));
      BOOST_TEST(o.peak_after_jy() <= o.peak_before_jy());
      BOOST_TEST(std::isfinite(o.peak_after_jy()));
      BOOST_TEST(o.single == (o.accuracy > 1e-5));  // as the planner chooses for images so small
    }
}

}  // namespace

BOOST_AUTO_TEST_CASE(weights_over_sixty_orders_of_magnitude_keep_the_promise) {
  check(run_cases(weight_cases(few_samples())));
}

BOOST_AUTO_TEST_CASE(clean_beside_1e9_jansky_goes_as_deep_as_single_precision_visibilities_do) {
  const StabilityData data = few_samples();
  const std::vector<StabilityOutcome> outcomes = run_cases({dynamic_range_cases(data).back()});
  check(outcomes);
  // Visibilities of 10⁹ Jy are rounded to 64 Jy, evenly: what is left is the peak of such noise, at most 6 times its RMS.
  const double noise_jy = 64 / std::sqrt(12.0) / std::sqrt(static_cast<double>(data.block.samples()));
  BOOST_TEST(outcomes.back().peak_after_jy() < 6 * noise_jy);
}

BOOST_AUTO_TEST_CASE(a_million_equal_samples_in_one_cell_keep_the_promise, *boost::unit_test::label("sweep")) {
  check(run_cases({one_cell_cases(1000000).back()}));
}

BOOST_AUTO_TEST_CASE(places_on_a_line_or_in_few_cells_keep_the_promise) {
  check(run_cases(few_places_cases(few_samples())));
}

BOOST_AUTO_TEST_CASE(a_clean_that_was_cut_says_of_how_many_components_and_which_model_was_kept) {
  StabilityOutcome cut;
  cut.max_iterations = 300;
  cut.clean.stop = imager::CleanStop::iteration_limit;
  cut.clean.cycles.resize(4);
  cut.clean.iterations = 163;
  const auto ended = [&] {
    const DataTable table = outcome_table("name", "title", {cut});
    const auto at = std::find(table.columns.begin(), table.columns.end(), "CLEAN ended") - table.columns.begin();
    return std::get<std::string>(table.rows.at(0).at(static_cast<std::size_t>(at)));
  };
  cut.clean.kept = 3;
  BOOST_TEST(ended() == "at the limit given, of 300 components");
  cut.clean.kept = 2;
  BOOST_TEST(ended() == "at the limit given, of 300 components; the best model, of 163, kept");
}

BOOST_AUTO_TEST_CASE(samples_where_cells_meet_and_where_the_grid_ends_keep_the_promise) {
  check(run_cases(boundary_cases(few_samples())));
}

BOOST_AUTO_TEST_CASE(samples_at_the_grid_s_end_are_used) {
  const StabilityCase edge = boundary_cases(few_samples()).front();
  const double per_cell = 2 * edge.geometry.cell_rad;
  bool any = false;
  for (const double x : edge.block->uvw_m) any = any || std::abs(x) * per_cell == 1;
  BOOST_TEST(any);
}

BOOST_AUTO_TEST_CASE(bands_of_three_to_one_keep_the_promise) {
  const std::vector<StabilityCase> cases = bandwidth_cases(few_samples());
  check(run_cases({cases.front(), cases.back()}));
}

BOOST_AUTO_TEST_CASE(w_keeps_the_promise_until_phases_lose_their_digits_and_then_says_so) {
  const auto cases = w_cases(few_samples(), {0, 1e6, 1e9});
  const std::vector<StabilityOutcome> outcomes = run_cases(cases);
  check(outcomes);
  BOOST_TEST(outcomes[3].refusal.empty());
  BOOST_TEST(!outcomes[5].refusal.empty());
  BOOST_TEST(outcomes[5].measured.rms > 1e-9);  // it would not have been kept
}

BOOST_AUTO_TEST_CASE(phase_centres_at_the_poles_keep_the_promise) {
  check(run_cases(pole_cases(few_samples())));
}

BOOST_AUTO_TEST_CASE(images_of_the_poles_have_headers_that_read_back) {
  const misfit::testing::TemporaryFolder folder;
  for (const StabilityCase& at : pole_cases(few_samples())) {
    imager::SkyImage sky;
    sky.image = imager::Image(stability_pixels, stability_pixels);
    sky.geometry = at.geometry;
    sky.observation.phase_centre = at.geometry.phase_centre;
    const std::string path = folder / "pole.fits";
    imager::write_fits(sky, path, imager::PixelFormat::float64);
    const imager::SkyDirection centre = imager::read_fits(path).geometry.phase_centre;
    // Headers hold degrees in 15 digits at least.
    BOOST_TEST(std::abs(centre.dec_rad - at.geometry.phase_centre.dec_rad) <= 1e-14);
    BOOST_TEST(std::abs(centre.ra_rad - at.geometry.phase_centre.ra_rad) <= 1e-14);
  }
}

BOOST_AUTO_TEST_CASE(pixels_at_the_poles_come_back_from_the_sky) {
  const ReportSection section = poles_section(few_samples());
  for (const auto& row : section.tables.front().rows) {
    // Rounding of angles near π, 4.4e-16 rad, against pixels of 1″ and of 1°.
    BOOST_TEST(std::get<double>(row.at(1)) < 1e-9);
    BOOST_TEST(std::get<double>(row.at(2)) < 1e-12);
  }
}

BOOST_AUTO_TEST_SUITE_END()
