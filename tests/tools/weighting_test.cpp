// Images weighted by the program, also against the installed WSClean, where there is one.
#include "tests/tools/program.h"

BOOST_AUTO_TEST_SUITE(weighting)

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

/// What an image is of.
struct Field {
  std::string vis;
  std::string pixels;
  std::string cell_arcsec;
  Arguments ours{};    ///< what else the program is told
  Arguments theirs{};  ///< the same in WSClean's words
};

/// Its PSF, made in the image's own uv grid.
imager::SkyImage wsclean_psf(const Field& field, const std::string& name, const Arguments& weighting) {
  const Arguments words{"-quiet",
                        "-name",
                        name,
                        "-size",
                        field.pixels,
                        field.pixels,
                        "-scale",
                        field.cell_arcsec + "asec",
                        "-make-psf-only",
                        "-use-wgridder",
                        "-no-small-inversion",
                        "-padding",
                        "1",
                        "-weighting-rank-filter",
                        "0",
                        "-reorder",
                        "-no-update-model-required",
                        "-weight"};
  const Outcome outcome = Child(words + weighting + field.theirs + Arguments{field.vis}, "wsclean").wait();
  BOOST_REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  return imager::read_fits(name + "-psf.fits");
}

Arguments ours(const Arguments& way) {
  Arguments words{"--weighting", way[0]};
  if (way.size() > 1) words = words + Arguments{"--robust", way[1]};
  return words;
}

/// PSFs to 1 % of the peak, beams to 2 %, as far as weights that are told differently for Stokes I allow.
void check_against_wsclean(const Field& field, const std::string& name, const Arguments& way) {
  succeed(Arguments{"image", "--vis", field.vis, "--imagename", name, "--imsize", field.pixels, "--cell",
                    field.cell_arcsec + "arcsec"} +
          field.ours + ours(way));
  const imager::Image psf = pixels_of(name, "psf");
  const imager::SkyImage other = wsclean_psf(field, name, way);
  double largest = 0;
  for (std::size_t i = 0; i < psf.pixel.size(); ++i) largest = std::max(largest, std::abs(psf.pixel[i] - other.image.pixel[i]));
  BOOST_TEST_MESSAGE("PSFs differ by " << largest);
  BOOST_TEST(largest < 0.01);
  const json beam = report_of(name)["beam_by_quadrant"];  // as WSClean fits
  constexpr double arcsec = M_PI / 180 / 3600;
  BOOST_TEST(std::abs(beam["major_arcsec"].get<double>() * arcsec / other.beam.major_rad - 1) < 0.02);
  BOOST_TEST(std::abs(beam["minor_arcsec"].get<double>() * arcsec / other.beam.minor_rad - 1) < 0.02);
}

const std::vector<Arguments> ways{{"uniform"},     {"briggs", "-2"},  {"briggs", "-0.5"},
                                  {"briggs", "0"}, {"briggs", "0.5"}, {"briggs", "2"}};

}  // namespace

BOOST_AUTO_TEST_CASE(psfs_and_beams_agree_with_wsclean) {
  if (!installed()) return;
  const Observation data;
  for (const Arguments& way : ways) {
    BOOST_TEST_CONTEXT(way.back()) {
      check_against_wsclean({data.vis, std::to_string(pixels), "0.1"}, data.folder / "a", way);
    }
  }
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_AUTO_TEST_CASE(psfs_and_beams_of_real_sets_agree_with_wsclean) {
  if (!installed()) return;
  const Arguments corrected{"--datacolumn", "corrected"}, corrected_too{"-data-column", "CORRECTED_DATA"};
  // The PSFs of ALMA and VLBA differ by up to 0.004 and 0.009, since WSClean weighs Stokes I by the smaller weight of two
  // hands; the others by up to 3e-4. ASKAP's cell is half the recipe's, with which a beam is a pixel wide: WSClean's fit to a
  // quadrant of so few pixels jumps where one of them changes by 1e-5.
  const std::map<std::string, Field> fields{
      {"alma_hd142527_b9", {"", "256", "0.04"}},
      {"lofar_3c295_snapshot",
       {"", "512", "20", corrected + Arguments{"--uvrange", "<5klambda"}, corrected_too + Arguments{"-maxuv-l", "5000"}}},
      {"vlba_m87_mojave", {"", "512", "0.0002"}},
      {"askap36_sim_4chan", {"", "256", "3"}},
      {"atca_sim_tileddata", {"", "256", "2", corrected, corrected_too}}};
  for (const auto& [name, field] : fields) {
    const misfit::testing::Unpacked data(name);
    if (!data.present()) return;
    Field here = field;
    here.vis = data / (name + ".ms");
    for (const Arguments& way : ways) {
      BOOST_TEST_CONTEXT(name << " " << way.back()) {
        check_against_wsclean(here, data / "a", way);
      }
    }
  }
}

/// With the robustness that is usual for cubes; near uniform weights it is the outer samples that gain, and the beam is
/// smaller.
BOOST_AUTO_TEST_CASE(a_bandwidth_taper_lies_between_briggs_and_natural) {
  const TemporaryFolder folder;
  const std::string set = folder / "cube.ms", name = folder / "a";
  succeed({"simulate", "--output", set, "--frequency", "1GHz", "--channels", "8", "--channel-width", "50MHz", "--hours", "0.5",
           "--interval", "60"});
  std::vector<double> noise, major;
  for (const Arguments& weighting :
       {Arguments{"briggs", "--robust", "0.5"}, {"briggsbwtaper", "--robust", "0.5"}, {"natural"}}) {
    succeed(Arguments{"image", "--vis", set, "--imagename", name, "--imsize", "512", "--cell", "0.2arcsec", "--specmode",
                      "cube", "--outframe", "TOPO", "--weighting"} +
            weighting);
    const nlohmann::json plane = report_of(name)["planes"][4];
    noise.push_back(plane["noise"]["predicted_jy"]);
    major.push_back(plane["beam"]["major_arcsec"]);
  }
  BOOST_TEST((noise[0] > noise[1] && noise[1] > noise[2]));
  BOOST_TEST((major[0] < major[1] && major[1] < major[2]));
  const Outcome band = run(
      {"image", "--vis", set, "--imagename", name, "--imsize", "64", "--cell", "0.2arcsec", "--weighting", "briggsbwtaper"});
  BOOST_TEST(band.code == 2);
  BOOST_TEST(band.err.find("--weighting briggsbwtaper: expected --specmode cube beside it") != std::string::npos);
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
