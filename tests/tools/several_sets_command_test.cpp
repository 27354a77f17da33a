// Several sets, and sets phased to several directions, as one image.
#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(several_sets_command)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;

constexpr double degree = M_PI / 180;

/// Two observations of one source of 3 Jy, at 30° and 40°, phased to half a degree from it and from each other.
struct TwoSets {
  TemporaryFolder folder;
  std::string first = folder / "first one.ms", second = folder / "second.ms";

  TwoSets() {
    std::ofstream(folder / "sky.csv") << "ra_deg,dec_deg,flux_jy\n30,40,3\n";
    simulate(first, "30.5deg", "40.1deg", "1");
    simulate(second, "29.8deg", "39.6deg", "3");
  }
  Arguments image(const std::vector<std::string>& sets) const {
    Arguments words{"image", "--vis"};
    return words + sets + Arguments{"--imagename", folder / "a", "--imsize", "64", "--cell", "5arcsec", "--quiet"};
  }
  Arguments shifted() const {
    return image({first, second}) + Arguments{"--phasecenter", "J2000 2h00m00s +40d00m00s", "--force-average"};
  }

 private:
  void simulate(const std::string& set, const std::string& ra, const std::string& dec, const std::string& channels) const {
    succeed({"simulate", "--output", set, "--sky", folder / "sky.csv", "--noncoplanar", "--array", "vla-d", "--ra", ra, "--dec",
             dec, "--channels", channels, "--quiet"});
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(sets_phased_apart_are_one_image_of_the_source_that_they_are_shifted_to) {
  const TwoSets sets;
  succeed(sets.shifted());
  const imager::SkyImage sky = imager::read_fits(sets.folder / "a.residual.fits");
  BOOST_TEST(std::abs(sky.geometry.phase_centre.ra_rad - 30 * degree) < 1e-12);
  BOOST_TEST(std::abs(sky.geometry.phase_centre.dec_rad - 40 * degree) < 1e-12);
  // All visibilities are 3 Jy there, to the roundings of single precision and the accuracy asked, 1e-6.
  BOOST_TEST(std::abs(sky.image.at(32, 32) / 3 - 1) < 3e-6);
  const auto report = report_of(sets.folder / "a");
  BOOST_TEST(report["visibilities"]["samples_read"].get<int>() == (1 + 3) * 351);
  succeed({"image", "--config", sets.folder / "a.last.ini", "--imagename", sets.folder / "again"});
  BOOST_CHECK(content(sets.folder / "a.residual.fits").size() == content(sets.folder / "again.residual.fits").size());
  BOOST_CHECK(pixels_of(sets.folder / "a", "residual").pixel == pixels_of(sets.folder / "again", "residual").pixel);
}

BOOST_AUTO_TEST_CASE(each_set_may_have_a_selection_of_its_own) {
  const TwoSets sets;  // of 1 and 3 channels, and 351 rows each
  const auto read = [&](const std::string& name) {
    return report_of(sets.folder / name)["visibilities"]["samples_read"].get<int>();
  };
  const Arguments selection{"--spw", "", "0:0, 0:2", "--scan", "1", "--antenna", "!0 ", ""};
  succeed(sets.shifted() + selection);
  BOOST_TEST(read("a") == 325 + 2 * 351);  // 26 rows are of antenna 0
  succeed({"image", "--config", sets.folder / "a.last.ini", "--imagename", sets.folder / "again"});
  BOOST_TEST(read("again") == read("a"));
  BOOST_TEST(run(sets.shifted() + Arguments{"--spw", "0", "0", "0"}).err ==
             "misfit: --spw: 3 expressions for 2 sets; expected one for all, or one for each\n");
  // A file of options has one expression, whatever is in it, unless it is quoted.
  std::ofstream(sets.folder / "one.ini") << "spw = 0:0, *:0\n";
  succeed(sets.shifted() + Arguments{"--config", sets.folder / "one.ini"});
  BOOST_TEST(read("a") == 2 * 351);
}

BOOST_AUTO_TEST_CASE(the_model_is_written_into_each_set_as_that_sees_it) {
  const TwoSets sets;
  succeed(sets.shifted() + Arguments{"--niter", "1", "--gain", "1", "--savemodel", "modelcolumn"});
  for (const std::string& set : {sets.first, sets.second}) {
    const auto data = visibilities(set, "DATA"), model = visibilities(set, "MODEL_DATA");
    BOOST_REQUIRE(data.size() == model.size());
    // The component is the dirty image's peak, right to 3e-6, and predicted to 1e-6.
    for (std::size_t i = 0; i < data.size(); ++i) BOOST_TEST(std::abs(model[i] - data[i]) < 3 * 5e-6F);
  }
}

BOOST_AUTO_TEST_CASE(a_phase_centre_that_the_antennas_hardly_see_is_warned_of) {
  const TemporaryFolder folder;  // the snapshot's field lies at +40d; λ/D is 0.17 degrees
  for (const char* specmode : {"mfs", "cube"}) {
    const auto warnings_at = [&](const std::string& dec) {
      succeed(small_image(snapshot(), folder / "a") +
              Arguments{"--phasecenter", "J2000 4h00m00s " + dec, "--specmode", specmode});
      return report_of(folder / "a")["warnings"].dump();
    };
    BOOST_TEST(warnings_at("+40d06m00s").find("first null") == std::string::npos);  // 0.6 λ/D: within the main lobe
    const std::string far = warnings_at("+42d00m00s");
    BOOST_TEST(far.find("beyond the first null of the beam: field 0 (SIMULATED), 120 arcmin away (11.8 beam widths)") !=
                   std::string::npos,
               far);
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_one_image_is_one_line_that_says_why) {
  const TwoSets sets;
  const auto said = [](const Arguments& arguments, int code) {
    const Outcome outcome = run(arguments);
    BOOST_TEST(outcome.code == code);
    BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    return outcome.err;
  };
  const std::string apart = said(sets.image({sets.first, sets.second}), 1);
  for (const std::string& part : {sets.first, sets.second, std::string(" apart"), std::string("--phasecenter")})
    BOOST_TEST(apart.find(part) != std::string::npos, apart);
  const std::string twice = said(sets.image({sets.first, sets.second, sets.folder / "./first one.ms/"}), 2);
  BOOST_TEST(twice.find("expected each set once") != std::string::npos, twice);
  const std::string missing = said(sets.image({sets.first, sets.folder / "none.ms"}), 1);
  BOOST_TEST(missing.find("none.ms does not exist") != std::string::npos, missing);
  const std::string nowhere = said(sets.image({sets.first}) + Arguments{"--phasecenter", "nowhere"}, 1);
  BOOST_TEST(nowhere.find("--phasecenter 'nowhere'") != std::string::npos, nowhere);
}

BOOST_AUTO_TEST_SUITE_END()
