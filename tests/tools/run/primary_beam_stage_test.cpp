#include "tools/run/primary_beam_stage.h"

#include <cmath>
#include <fstream>

#include "imager/beams/airy_pattern.h"
#include "imager/beams/telescopes.h"
#include "imager/numerics/constants.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"
#include "tests/tools/program.h"

BOOST_AUTO_TEST_SUITE(primary_beam_stage)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;
using tools::BeamScene;
using tools::PrimaryBeamStage;

constexpr double arcsec = imager::pi / 180 / 3600, degree = 3600 * arcsec;
const imager::SkyDirection middle{1.0, 0.7, "FK5"};

BeamScene scene(const std::vector<imager::AntennaSort>& sorts) {
  BeamScene scene;
  scene.rows.sorts = sorts;
  scene.rows.pointings = {{"0 (M51)", middle}};
  scene.geometry = {41, 31, 20 * arcsec, middle};
  scene.frequency_hz = 1.2e9;
  return scene;
}

PrimaryBeamStage stage(const BeamScene& scene, double pblimit = 0) {
  return {{.pbcor = true, .pblimit = pblimit}, scene, 1};
}

std::string refusal(const BeamScene& scene) {
  try {
    stage(scene);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

/// Its beam's row through the middle.
double beside(const imager::Image& beam, const BeamScene& scene, int pixels) {
  return beam.at(scene.geometry.centre_row(), scene.geometry.centre_column() + pixels);
}

/// A VLA in its D configuration that sees one source of 2.5 Jy, as its dishes see it at each of 16 channels around 1.5 GHz. The
/// source lies at about the half-power radius, on a pixel of 15″: 42.2′ / 1.5 / 2 is 56.3 of them.
void simulate_seen(const std::string& path, double bandwidth_mhz) {
  std::ofstream(path + ".csv") << "l_arcsec,m_arcsec,flux_jy\n" << 46 * 15 << "," << -34 * 15 << ",2.5\n";
  const double width = bandwidth_mhz / 16;
  succeed({"simulate", "--output", path, "--sky", path + ".csv", "--array", "vla-d", "--primary-beam", "--frequency",
           std::to_string(1500 - 7.5 * width) + "MHz", "--channels", "16", "--channel-width", std::to_string(width) + "MHz",
           "--hours", "2", "--interval", "600"});
}

/// From 1 to 2 GHz.
const std::string& seen_through_dishes() {
  static const misfit::testing::TemporaryFolder folder;
  static const std::string path = [] {
    simulate_seen(folder / "seen.ms", 1000);
    return folder / "seen.ms";
  }();
  return path;
}

Arguments wide_image(const std::string& imagename, const std::string& vis = seen_through_dishes()) {
  return {"image", "--vis", vis, "--imagename", imagename, "--imsize", "256", "--cell", "15arcsec"};
}

constexpr int source_row = 128 - 34, source_column = 128 - 46;

}  // namespace

BOOST_AUTO_TEST_CASE(a_source_at_half_power_is_corrected_to_its_flux_over_an_octave_with_any_weights) {
  const misfit::testing::TemporaryFolder folder;
  for (const Arguments& options : {Arguments{}, Arguments{"--weighting", "uniform"}, Arguments{"--uvtaper", "2arcmin"}}) {
    succeed(wide_image(folder / "a") + Arguments{"--pbcor"} + options);
    const double beam = pixels_of(folder / "a", "pb").at(source_row, source_column);
    const double seen = pixels_of(folder / "a", "residual").at(source_row, source_column);
    const double flux = pixels_of(folder / "a", "image.pbcor").at(source_row, source_column);
    BOOST_TEST(std::abs(beam - 0.5) < 0.1);  // weights move the mean frequency
    BOOST_TEST(std::abs(flux - seen / beam) < 1e-6);
    // What single precision and the accuracy of 1e-6 leave.
    BOOST_TEST(std::abs(flux / 2.5 - 1) < 1e-5);
  }
}

BOOST_AUTO_TEST_CASE(a_cleaned_source_at_half_power_is_corrected_to_its_flux_within_a_thousandth) {
  // Over a fifth of the frequency: CLEAN with one plane for all of it spreads a source whose flux falls with frequency, as all
  // do that lie off axis, over some pixels, by which its peak errs by 1e-4 here, and by 7e-3 over an octave.
  const misfit::testing::TemporaryFolder folder;
  simulate_seen(folder / "seen.ms", 300);
  succeed(wide_image(folder / "a", folder / "seen.ms") + Arguments{"--pbcor", "--niter", "300", "--threshold", "1mJy"});
  BOOST_TEST(std::abs(pixels_of(folder / "a", "image.pbcor").at(source_row, source_column) / 2.5 - 1) < 1e-3);
  BOOST_TEST(std::abs(pixels_of(folder / "a", "image").at(source_row, source_column) / 2.5 - 0.5) < 0.02);
}

BOOST_AUTO_TEST_CASE(the_beam_stays_where_antennas_pointed_when_the_image_is_elsewhere) {
  const misfit::testing::TemporaryFolder folder;
  // The source's place, 4h + ~0.3 degrees: simulated at right ascension 60°, declination 40°.
  const imager::SkyDirection source =
      imager::sky_direction({46 * 15 * arcsec, -34 * 15 * arcsec}, {60 * degree, 40 * degree, "FK5"});
  std::ostringstream direction;
  direction.precision(15);
  direction << "J2000 " << source.ra_rad / degree << "deg " << source.dec_rad / degree << "deg";
  succeed(wide_image(folder / "a") + Arguments{"--pbcor", "--phasecenter", direction.str()});
  BOOST_TEST(std::abs(pixels_of(folder / "a", "image.pbcor").at(128, 128) / 2.5 - 1) < 1e-5);
}

BOOST_AUTO_TEST_CASE(files_are_written_as_asked_masked_below_the_limit_and_removed_by_the_next_run) {
  const misfit::testing::TemporaryFolder folder;
  const auto exists = [&](const char* kind) { return std::filesystem::exists(folder / ("a." + std::string(kind) + ".fits")); };
  succeed(wide_image(folder / "a") + Arguments{"--pbcor", "--pblimit", "-0.4"});
  const imager::Image beam = pixels_of(folder / "a", "pb"), image = pixels_of(folder / "a", "image.pbcor");
  std::size_t masked = 0;
  for (std::size_t i = 0; i < beam.pixel.size(); ++i) {
    masked += std::isnan(beam.pixel[i]);
    BOOST_TEST(std::isnan(beam.pixel[i]) == std::isnan(image.pixel[i]));
    BOOST_TEST(!(beam.pixel[i] < 0.4 - 1e-6));
  }
  BOOST_TEST(masked > beam.pixel.size() / 4);
  BOOST_TEST(masked < beam.pixel.size());
  BOOST_TEST(beam.at(128, 128) == 1.0);
  succeed(wide_image(folder / "a") + Arguments{"--pblimit", "0.1"});
  BOOST_TEST(exists("pb"));
  BOOST_TEST(!exists("image.pbcor"));
  Outcome next = run(wide_image(folder / "a"));
  BOOST_TEST(next.code == 0);
  BOOST_TEST(!exists("pb"));
  BOOST_TEST(next.err.find("a.pb.fits") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_run_that_was_cleaned_can_be_restarted_for_its_correction) {
  const misfit::testing::TemporaryFolder folder;
  const Arguments clean{"--niter", "50"};
  succeed(wide_image(folder / "a") + clean);
  const double seen = pixels_of(folder / "a", "image").at(source_row, source_column);
  succeed(wide_image(folder / "a") + clean + Arguments{"--restart", "--pbcor"});
  const double beam = pixels_of(folder / "a", "pb").at(source_row, source_column);
  BOOST_TEST(std::abs(pixels_of(folder / "a", "image.pbcor").at(source_row, source_column) - seen / beam) < 1e-6);
}

BOOST_AUTO_TEST_CASE(the_plan_tells_which_beam_was_taken) {
  const Outcome plan = run(wide_image("nowhere") + Arguments{"--pbcor", "--dry-run"});
  BOOST_TEST(plan.code == 0);
  BOOST_TEST(plan.out.find("primary beam: 27.94 arcmin wide at half power at 1.5 GHz, where it is 0.2 or more; "
                           "EVLA: fits to its measured beams") != std::string::npos);
  const Outcome without = run(wide_image("nowhere") + Arguments{"--dry-run"});
  BOOST_TEST(without.out.find("primary beam:") == std::string::npos);
  BOOST_TEST(without.out.find("; primary beam FWHM 27.9 arcmin at 1.5 GHz\n") != std::string::npos);
  const Outcome wrong = run(wide_image("nowhere") + Arguments{"--pblimit", "1.5"});
  BOOST_TEST(wrong.code == 2);
  BOOST_TEST(wrong.err.find("--pblimit 1.5: expected a number between -1 and 1") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(pairs_weigh_as_their_samples_do) {
  BeamScene alma = scene({{"ALMA", 12, "DA41"}, {"ALMA", 7, "CM01"}});
  imager::VisibilityBlock block = imager::testing::random_samples(40, 2, alma.geometry.cell_rad, 1);
  for (std::size_t row = 0; row < 40; ++row)
    alma.rows.pairs.push_back({static_cast<std::uint8_t>(row % 4 == 0), static_cast<std::uint8_t>(row % 2 == 0)});
  PrimaryBeamStage beams = stage(alma);
  beams.weigh(imager::testing::stored({block}));
  double expected = 0, weight = 0;
  const double sine = 10 * alma.geometry.cell_rad;
  for (std::size_t row = 0; row < 40; ++row)
    for (std::size_t c = 0; c < 2; ++c) {
      const double per_wavelength = sine * block.frequency_hz[c] / imager::speed_of_light_m_s, w = block.weight[2 * row + c];
      const auto voltage = [&](bool compact) {
        return imager::airy_voltage(compact ? imager::Dish{6.25, 0.75} : imager::Dish{10.7, 0.75}, per_wavelength);
      };
      expected += w * voltage(row % 4 == 0) * voltage(row % 2 == 0);
      weight += w;
    }
  BOOST_TEST(std::abs(beside(beams.whole_band(), alma, 10) - expected / weight) < 1e-9);
}

BOOST_AUTO_TEST_CASE(a_plane_has_the_beam_of_its_frequency) {
  const BeamScene vla = scene({{"EVLA", 25, "ea01"}});
  PrimaryBeamStage beams = stage(vla);
  beams.weigh(imager::testing::stored({imager::testing::random_samples(40, 2, vla.geometry.cell_rad, 1)}));
  for (const double hz : {1.0e9, 1.3e9}) {
    const double voltage = imager::beam_model({"EVLA", 25}).pattern->voltage(15 * vla.geometry.cell_rad, hz);
    BOOST_TEST(std::abs(beside(beams.at(hz), vla, 15) - voltage * voltage) < 1e-9);
  }
}

BOOST_AUTO_TEST_CASE(what_has_no_simple_beam_is_refused_in_a_line) {
  BOOST_TEST(refusal(scene({{"LOFAR", 31.26, "CS001HBA0"}})) ==
             "LOFAR has no simple primary beam: its stations are arrays of dipoles, whose beams change with "
             "direction, time and frequency; --beam gives one");
  BOOST_TEST(refusal(scene({{"EVLA", 25, "ea01"}})) == "");
  BeamScene mosaic = scene({{"EVLA", 25, "ea01"}});
  mosaic.rows.pointings.push_back({"1 (M51b)", {middle.ra_rad, middle.dec_rad + 0.1 * degree, "FK5"}, 1});
  BOOST_TEST(refusal(mosaic) ==
             "antennas of fields 0 (M51) and 1 (M51b) pointed 6 arcmin apart; --gridder mosaic "
             "makes one image of them, or select one with --field");
  mosaic.rows.pointings.front().set = "a.ms";
  mosaic.rows.pointings.back().set = "b.ms";
  BOOST_TEST(refusal(mosaic) ==
             "antennas of fields 0 (M51) of a.ms and 1 (M51b) of b.ms pointed 6 arcmin apart; --gridder mosaic "
             "makes one image of them, or select one with --vis");
  mosaic.rows.pointings.back().set = mosaic.rows.pointings.front().set;
  mosaic.rows.pointings.back().id = mosaic.rows.pointings.front().id;
  BOOST_TEST(refusal(mosaic).find("field and image move past each other: choose some of its time with --timerange") !=
             std::string::npos);
  mosaic.rows.pointings.back().direction.dec_rad = middle.dec_rad + 1 * arcsec;  // of a beam of 35′
  BOOST_TEST(refusal(mosaic) == "");
  mosaic.rows.pointings = {{"0 (M51)", {middle.ra_rad + imager::pi, -middle.dec_rad, "FK5"}}};
  BOOST_TEST(refusal(mosaic) ==
             "antennas of field 0 (M51) pointed more than 90 degrees away from the image; "
             "expected one within its hemisphere");
  BeamScene beside_axis = scene({{"ATCA", 22, "ATCA1"}});
  beside_axis.rows.feeds = {{0, 0.15 * degree, -0.2 * degree}};
  BOOST_TEST(refusal(beside_axis) ==
             "FEED's column BEAM_OFFSET says that beams point 15 arcmin beside the "
             "field's direction; expected beams on the axis of their dishes");
  BOOST_TEST(refusal(scene({})).find("no row of two antennas is selected") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(an_image_that_antennas_do_not_see_is_told_of) {
  BeamScene away = scene({{"EVLA", 25, "ea01"}});
  away.rows.pointings[0].direction.dec_rad += 2 * degree;
  PrimaryBeamStage beams = stage(away, 0.3);
  beams.weigh(imager::testing::stored({imager::testing::random_samples(40, 2, away.geometry.cell_rad, 1)}));
  BOOST_TEST(
      beams.warning_of(beams.whole_band()) ==
      "the primary beam is below --pblimit 0.3 in all of the image: the antennas pointed 120 arcmin from its phase centre");
  const BeamScene here = scene({{"EVLA", 25, "ea01"}});
  PrimaryBeamStage seen = stage(here);
  seen.weigh(imager::testing::stored({imager::testing::random_samples(40, 2, here.geometry.cell_rad, 1)}));
  BOOST_TEST(seen.warning_of(seen.whole_band()) == "");
}

BOOST_AUTO_TEST_CASE(real_sets_have_the_beams_of_their_dishes_or_are_refused) {
  using misfit::testing::Unpacked;
  const Unpacked alma("alma_hd142527_b9"), lofar("lofar_3c295_snapshot"), askap("askap36_sim_4chan"),
      atca("atca_sim_tileddata");
  if (!alma.present() || !lofar.present() || !askap.present() || !atca.present()) return;
  const auto plan = [](const std::string& set) {
    return run(
        {"image", "--vis", set, "--imagename", "nowhere", "--imsize", "64", "--cell", "1arcsec", "--pbcor", "--dry-run"});
  };
  BOOST_TEST(plan(alma / "alma_hd142527_b9.ms").out.find("primary beam: 8.47 arcsec wide") != std::string::npos);
  BOOST_TEST(plan(askap / "askap36_sim_4chan.ms").err.find("ASKAP's beams are formed") != std::string::npos);
  const Outcome stations = plan(lofar / "lofar_3c295_snapshot.ms");
  BOOST_TEST(stations.code == 1);
  BOOST_TEST(stations.err.find("LOFAR has no simple primary beam") != std::string::npos);
  const Outcome five_beams = plan(atca / "atca_sim_tileddata.ms");
  BOOST_TEST(five_beams.code == 1);
  BOOST_TEST(five_beams.err.find("BEAM_OFFSET says that beams point 21.2 arcmin beside") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
