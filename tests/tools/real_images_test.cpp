// Observations of other people; see Unpacked.
#include "tests/tools/program.h"

namespace {

using namespace misfit;
using namespace misfit::tools::testing;
using misfit::testing::Unpacked;

double peak(const imager::Image& image) {
  return *std::max_element(image.pixel.begin(), image.pixel.end());
}

/// The pixel `r` pixels from the centre towards the position angle `pa_deg`, from north through east.
double towards(const imager::Image& image, double r, double pa_deg) {
  const double angle = pa_deg * M_PI / 180;
  return image.at(image.height / 2 + static_cast<int>(std::lround(r * std::cos(angle))),
                  image.width / 2 - static_cast<int>(std::lround(r * std::sin(angle))));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(real_images)

BOOST_AUTO_TEST_CASE(alma_shows_the_dust_ring_with_its_gap) {
  const Unpacked data("alma_hd142527_b9");
  if (!data.present()) return;
  succeed({"image", "--vis", data / "alma_hd142527_b9.ms", "--imagename", data / "alma", "--imsize", "512", "--cell",
           "0.04arcsec", "--niter", "2000", "--nsigma", "3"});
  const nlohmann::json report = report_of(data / "alma");
  const imager::Image image = pixels_of(data / "alma", "image");
  // WSClean 3.1 with Briggs weights of robustness 0.5: peak 0.264 Jy/beam, rms 0.013, beam 0.320 by 0.269 arcsec. Natural
  // weights have the lowest noise and a larger beam, though not as large as to lose the ring of 1 arcsec.
  const double major = report["beam"]["major_arcsec"], minor = report["beam"]["minor_arcsec"];
  BOOST_TEST(report["clean"]["rms_jy"].get<double>() < 0.013);
  BOOST_TEST((major > 0.320 && major < 1.5 * 0.320));
  BOOST_TEST((minor > 0.269 && minor < 1.5 * 0.269));
  // The ring is as wide as the beam and more: its brightness per area stays, but for 20% of smoothing and noise of 5%.
  const double brightness = peak(image) / (major * minor), with_briggs = 0.264 / (0.320 * 0.269);
  BOOST_TEST((brightness > 0.8 * with_briggs && brightness < 1.1 * with_briggs));
  // A horseshoe: bright in the north, a hole in the middle, open in the south.
  double north = 0, south = 0;
  for (const double r : {15, 20, 25, 30}) {
    north = std::max(north, towards(image, r, 0));
    south = std::max(south, towards(image, r, 180));
  }
  BOOST_TEST(north > 0.5 * peak(image));
  BOOST_TEST(south < 0.2 * north);
  BOOST_TEST(std::abs(towards(image, 0, 0)) < 0.2 * north);
  BOOST_TEST(report["warnings"].empty());  // w, which is not negligible here, is imaged rather than warned of
}

BOOST_AUTO_TEST_CASE(vlba_shows_the_core_and_the_jet_to_the_west) {
  const Unpacked data("vlba_m87_mojave");
  if (!data.present()) return;
  succeed({"image", "--vis", data / "vlba_m87_mojave.ms", "--imagename", data / "vlba", "--imsize", "512", "--cell",
           "0.0002arcsec", "--niter", "5000", "--nsigma", "3", "--verify", "100"});
  const nlohmann::json report = report_of(data / "vlba");
  const imager::Image image = pixels_of(data / "vlba", "image");
  // WSClean 3.1 with Briggs weights of robustness 0: peak 1.38 Jy/beam. The larger natural beam gathers more of the flux,
  // never more than all of it.
  BOOST_TEST(peak(image) > 1.38);
  BOOST_TEST(peak(image) < report["clean"]["model_flux_jy"].get<double>());
  // The phase centre is the core; M87's jet starts towards position angle 285 degrees, and there is no counter-jet.
  BOOST_TEST(image.at(256, 256) > 0.95 * peak(image));
  for (const double r : {15, 20, 25}) BOOST_TEST(towards(image, r, 285) > 5 * std::abs(towards(image, r, 105)));
}

BOOST_AUTO_TEST_CASE(a_bad_input_is_imaged_or_refused_with_one_line) {
  const Unpacked data("bad_inputs");
  if (!data.present()) return;
  for (const auto& entry : std::filesystem::directory_iterator(data / "bad_inputs")) {
    BOOST_TEST_CONTEXT(entry.path()) {
      const Outcome outcome = run(small_image(entry.path(), data / "bad") + Arguments{"--quiet", "--verify", "5"});
      BOOST_TEST_CONTEXT(outcome.err) {
        BOOST_TEST((outcome.code == 0 || outcome.code == 1));
        BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == outcome.code);
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
