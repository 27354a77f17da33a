// Models that dishes see through their primary beams: simulated, predicted, and in mosaics of pointings.
#include <boost/test/data/test_case.hpp>
#include <cmath>
#include <complex>

#include "tests/tools/beam_files.h"
#include "tests/tools/program.h"
#include "tests/tools/ranks_program.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(seen_models)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::tools::testing;
using Visibilities = std::vector<std::complex<float>>;

namespace {

/// ‖a − b‖ / ‖b‖.
double distance(const Visibilities& a, const Visibilities& b) {
  BOOST_REQUIRE_EQUAL(a.size(), b.size());
  double error = 0, norm = 0;
  for (std::size_t i = 0; i < a.size(); ++i) error += std::norm(a[i] - b[i]), norm += std::norm(b[i]);
  return std::sqrt(error / norm);
}

/// Points on pixels of 20″ about 60°, 40°, within half a degree.
constexpr const char* points =
    "l_arcsec,m_arcsec,flux_jy\n0,0,1\n300,-200,2\n-480,120,0.7\n-200,-640,1.5\n700,500,3\n-900,-100,0.4\n";

/// Two sorts of dishes and pointings about the points, over 40 % in frequency.
struct Mosaic {
  TemporaryFolder folder;
  std::string set = folder / "a.ms", list = folder / "sky.csv";

  Mosaic() {
    std::ofstream(list) << points;
    succeed({"simulate",
             "--output",
             set,
             "--sky",
             list,
             "--array",
             "vla-d",
             "--pointings",
             "hex,7,9arcmin",
             "--dishes",
             "25,13",
             "--primary-beam",
             "--beam",
             "airy",
             "--frequency",
             "1.2GHz",
             "--channels",
             "6",
             "--channel-width",
             "100MHz",
             "--interval",
             "300"});
  }
};

const Arguments about_centre{"--phasecenter", "J2000 60deg 40deg"};
const Arguments by_airy{"--apply-beam", "--beam", "airy"};

}  // namespace

BOOST_AUTO_TEST_CASE(components_are_predicted_as_dishes_saw_them) {
  const Mosaic mosaic;
  const Arguments predict = Arguments{"predict", "--vis", mosaic.set, "--components", mosaic.list} + about_centre;
  succeed(predict + by_airy);
  // Sources about seven phase centres, and about one: the same but for the rounding of the visibilities in single precision.
  BOOST_TEST(distance(visibilities(mosaic.set, "MODEL_DATA"), visibilities(mosaic.set, "DATA")) < 1e-7);
  succeed(predict + Arguments{"--column", "UNSEEN"});
  BOOST_TEST(distance(visibilities(mosaic.set, "UNSEEN"), visibilities(mosaic.set, "DATA")) > 0.3);
  succeed(predict + Arguments{"--column", "OTHER", "--apply-beam", "--beam", "airy:25"});
  BOOST_TEST(distance(visibilities(mosaic.set, "OTHER"), visibilities(mosaic.set, "DATA")) > 0.05);
  if (!has_mpi()) return;
  succeed_together(3, predict + by_airy + Arguments{"--column", "TOGETHER"});
  BOOST_TEST((visibilities(mosaic.set, "TOGETHER") == visibilities(mosaic.set, "MODEL_DATA")));
}

BOOST_DATA_TEST_CASE(an_image_is_predicted_as_dishes_saw_it, bdata::make({1e-4, 1e-6}), accuracy) {
  const Mosaic mosaic;
  succeed(Arguments{"image", "--vis", mosaic.set, "--imagename", mosaic.folder / "a", "--imsize", "128", "--cell", "20arcsec",
                    "--niter", "1", "--field", "0"});
  imager::SkyImage model = imager::read_fits(mosaic.folder / "a.model.fits");
  model.image.pixel.assign(model.image.pixel.size(), 0);
  for (const auto& [l, m, flux] :
       {std::tuple(0, 0, 1.0), {300, -200, 2.0}, {-480, 120, 0.7}, {-200, -640, 1.5}, {700, 500, 3.0}, {-900, -100, 0.4}})
    model.image.at(64 + m / 20, 64 - l / 20) = flux;
  imager::write_fits(model, mosaic.folder / "sky.fits", imager::PixelFormat::float64);
  succeed(
      Arguments{"predict", "--vis", mosaic.set, "--model", mosaic.folder / "sky.fits", "--accuracy", std::to_string(accuracy)} +
      by_airy);
  BOOST_TEST(distance(visibilities(mosaic.set, "MODEL_DATA"), visibilities(mosaic.set, "DATA")) < accuracy + 1e-7);
}

/// Over four hours, in which the zenith turns by 90°.
BOOST_AUTO_TEST_CASE(beams_that_turn_are_applied_as_they_turned) {
  const TemporaryFolder folder;
  const std::string set = folder / "a.ms", list = folder / "sky.csv", beam = folder / "beam.fits";
  write_beam_file(beam, {}, [](double east, double north, double) {
    const double x = east * 60 / 40, y = north * 60 / 56;
    return std::exp(-4 * std::log(2.0) * (x * x + y * y));
  });
  std::ofstream(list) << points;
  const Arguments by_file{"--beam", beam};
  succeed(Arguments{"simulate", "--output", set, "--sky", list, "--array", "vla-d", "--frequency", "1.4GHz", "--hours", "4",
                    "--interval", "1200", "--primary-beam"} +
          by_file);
  succeed(Arguments{"predict", "--vis", set, "--components", list, "--apply-beam"} + by_file);
  // The zenith of the simulation is that of 2000, and the set's that of J2000: 0.01° about then.
  BOOST_TEST(distance(visibilities(set, "MODEL_DATA"), visibilities(set, "DATA")) < 2e-4);
}

BOOST_AUTO_TEST_CASE(pointings_and_beams_that_are_none_are_refused) {
  const TemporaryFolder folder;
  const auto refusal = [&](const Arguments& arguments) { return run(arguments).err; };
  const Arguments simulate{"simulate", "--output", folder / "a.ms"};
  const auto says = [](const std::string& text, const std::string& part) {
    BOOST_TEST(text.find(part) != std::string::npos, text);
  };
  for (const char* wrong : {"hex,0,1arcmin", "hex,7", "hex,2.5,1arcmin", "hex,7,-1arcmin", "hex,99999,1arcmin", "none.csv"})
    says(refusal(simulate + Arguments{"--pointings", wrong}), "expected hex,N,SPACING");
  says(refusal(simulate + Arguments{"--pointings", "hex,19,60deg"}), "reaches beyond 90 degrees");
  says(refusal(simulate + Arguments{"--pointings", "hex,7,1arcmin", "--coplanar"}),
       "--pointings hex,7,1arcmin with --coplanar");
  says(refusal(simulate + Arguments{"--dishes", "12,0"}), "--dishes 0: expected diameters above 0");
  const std::string list = folder / "pointings.csv";
  for (const auto& [text, expected] : {std::pair("", "lists no pointing"),
                                       {"ra,dec\n", "line 1: found 'ra,dec', expected the names"},
                                       {"ra_deg,dec_deg\n1,2\n1,95\n", "line 3: found '1,95', expected a right ascension"},
                                       {"ra_deg,dec_deg\n1\n", "line 2: found '1'"}}) {
    std::ofstream(list) << text;
    says(refusal(simulate + Arguments{"--pointings", list}), expected);
  }
  std::ofstream(list) << "# two\nra_deg,dec_deg\n60, 40\n60.2,40.1\n";
  succeed(simulate + Arguments{"--pointings", list});
  says(refusal({"predict", "--vis", folder / "a.ms", "--components", list, "--beam", "vla"}), "--apply-beam");
  const std::string sky = folder / "sky.csv";
  std::ofstream(sky) << points;
  says(refusal(
           {"predict", "--vis", folder / "a.ms", "--components", sky, "--apply-beam", "--phasecenter", "J2000 250deg 40deg"}),
       "pointed more than 90 degrees away from the model");
}

BOOST_AUTO_TEST_SUITE_END()
