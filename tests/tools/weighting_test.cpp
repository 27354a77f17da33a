// Images weighted by the program, also against the installed WSClean, where there is one.
#include <boost/test/data/test_case.hpp>

#include "tests/tools/program.h"

namespace bdata = boost::unit_test::data;
namespace {

using namespace misfit;
using namespace misfit::tools::testing;
using nlohmann::json;

constexpr int pixels = 256;

/// Noise of 1 Jy in every correlation, seen by the VLA.
struct Observation {
  TemporaryFolder folder;
  std::string vis = folder / "noise.ms";

  Observation() {
    std::ofstream(folder / "sky.csv") << "l_arcsec,m_arcsec,flux_jy\n0,0,1e-9\n";
    succeed({"simulate", "--output", vis, "--sky", folder / "sky.csv", "--coplanar", "--hours", "3", "--interval", "120",
             "--channels", "2", "--noise", "1Jy"});
  }
  json image(const Arguments& weighting) const {
    succeed(Arguments{"image", "--vis", vis, "--imagename", folder / "a", "--imsize", std::to_string(pixels), "--cell",
                      "0.1arcsec"} +
            weighting);
    return report_of(folder / "a");
  }
};

bool installed() {
  static const bool found = [] {
    const bool answers = Child({"--version"}, "wsclean").wait().code == 0;
    if (!answers) BOOST_TEST_MESSAGE("skipped: WSClean is not installed");
    return answers;
  }();
  return found;
}

/// Its PSF, made in the image's own uv grid.
imager::SkyImage wsclean_psf(const Observation& data, const Arguments& weighting) {
  const std::string size = std::to_string(pixels);
  const Outcome outcome =
      Child(Arguments{"-quiet", "-name", data.folder / "wsclean", "-size", size, size, "-scale", "0.1asec", "-make-psf-only",
                      "-use-wgridder", "-no-small-inversion", "-padding", "1", "-weighting-rank-filter", "0", "-weight"} +
                weighting + Arguments{data.vis},
            "wsclean")
          .wait();
  BOOST_REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  return imager::read_fits(data.folder / "wsclean-psf.fits");
}

const std::vector<Arguments> ways{{"uniform"},     {"briggs", "-2"},  {"briggs", "-0.5"},
                                  {"briggs", "0"}, {"briggs", "0.5"}, {"briggs", "2"}};

Arguments ours(const Arguments& way) {
  Arguments words{"--weighting", way[0]};
  if (way.size() > 1) words = words + Arguments{"--robust", way[1]};
  return words;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(weighting)

BOOST_AUTO_TEST_CASE(psfs_and_beams_agree_with_wsclean) {
  if (!installed()) return;
  const Observation data;
  for (const Arguments& way : ways) {
    BOOST_TEST_CONTEXT(way.back()) {
      const json report = data.image(ours(way));
      const imager::Image psf = pixels_of(data.folder / "a", "psf");
      const imager::SkyImage other = wsclean_psf(data, way);
      double largest = 0;
      for (std::size_t i = 0; i < psf.pixel.size(); ++i)
        largest = std::max(largest, std::abs(psf.pixel[i] - other.image.pixel[i]));
      BOOST_TEST_MESSAGE("PSFs differ by " << largest);
      BOOST_TEST(largest < 0.01);
      const json& beam = report["beam_by_quadrant"];  // as WSClean fits
      constexpr double arcsec = M_PI / 180 / 3600;
      BOOST_TEST(std::abs(beam["major_arcsec"].get<double>() * arcsec / other.beam.major_rad - 1) < 0.02);
      BOOST_TEST(std::abs(beam["minor_arcsec"].get<double>() * arcsec / other.beam.minor_rad - 1) < 0.02);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_noise_of_simulated_noise_is_the_one_predicted) {
  const Observation data;
  const json natural = data.image({})["noise"];
  for (const Arguments& weighting : {Arguments{}, {"--weighting", "uniform"}, {"--weighting", "briggs", "--robust", "0"}}) {
    const json noise = data.image(weighting)["noise"];
    const double predicted = noise["predicted_jy"], measured = noise["measured_jy"];
    // The image holds at least 2000 beams, and a median deviates 1.6 times as much as an RMS: three times 1.6/√4000 = 8 %.
    BOOST_TEST(std::abs(measured / predicted - 1) < 0.08);
    BOOST_TEST(predicted >= natural["predicted_jy"].get<double>() * (1 - 1e-12));
  }
}

BOOST_AUTO_TEST_SUITE_END()
