// Several pointings as one image, with --gridder mosaic.
#include <cmath>

#include "imager/data/image_statistics.h"
#include "tests/tools/program.h"
#include "tests/tools/ranks_program.h"
#include "tests/tools/set_changes.h"
#include "tools/formats/image_file.h"

BOOST_AUTO_TEST_SUITE(mosaic_image)

using namespace misfit;
using namespace misfit::tools::testing;
using imager::Image;
using nlohmann::json;

namespace {

/// Points on pixels of 24″, in Jy.
struct Point {
  int right, up;  ///< pixels from the middle
  double flux_jy;
};
const std::vector<Point> points{{0, 0, 1}, {-14, -8, 2}, {20, 5, 0.7}, {9, -27, 1.5}, {-30, 21, 3}, {38, -4, 0.4}};

constexpr int pixels = 160;

const Arguments one_centre{"--phasecenter", "J2000 60deg 40deg"};
const Arguments scene{"--imsize", std::to_string(pixels), "--cell", "24arcsec", "--accuracy", "1e-5"};

/// Seven pointings over a tenth in frequency.
struct Pointings {
  TemporaryFolder folder;
  std::string set = folder / "a.ms", list = folder / "sky.csv";

  explicit Pointings(const Arguments& more = {}, const std::string& dishes_m = "25,20") {
    std::ofstream sky(list);
    sky << "l_arcsec,m_arcsec,flux_jy\n";
    for (const Point& p : points) sky << -24 * p.right << ',' << 24 * p.up << ',' << p.flux_jy << '\n';
    sky.close();
    succeed(Arguments{"simulate",
                      "--output",
                      set,
                      "--sky",
                      list,
                      "--array",
                      "vla-d",
                      "--pointings",
                      "hex,7,15arcmin",
                      "--dishes",
                      dishes_m,
                      "--primary-beam",
                      "--beam",
                      "airy",
                      "--frequency",
                      "1.4GHz",
                      "--channels",
                      "4",
                      "--channel-width",
                      "50MHz",
                      "--hours",
                      "1",
                      "--interval",
                      "120"} +
            more);
  }
  Arguments image(const std::string& name, const Arguments& more = {}) const {
    return averaged(name, Arguments{"--beam", "airy"} + more);
  }
  /// Without a beam, which no average has.
  Arguments averaged(const std::string& name, const Arguments& more) const { return elsewhere(name, one_centre + more); }
  Arguments elsewhere(const std::string& name, const Arguments& more) const {
    return Arguments{"image", "--vis", set, "--imagename", folder / name} + scene + more;
  }
  Image pixels_of(const std::string& name) const { return imager::read_fits(folder / (name + ".fits")).image; }
  json report(const std::string& name) const { return json::parse(content(folder / (name + ".report.json"))); }
};

double at(const Image& image, const Point& p) {
  return image.at(image.height / 2 + p.up, image.width / 2 + p.right);
}

/// The largest difference of pixels that are numbers in both, over the largest magnitude.
double difference(const Image& a, const Image& b) {
  double largest = 0, size = 0;
  for (std::size_t i = 0; i < a.pixel.size(); ++i) {
    if (std::isnan(a.pixel[i]) || std::isnan(b.pixel[i])) continue;
    largest = std::max(largest, std::abs(a.pixel[i] - b.pixel[i]));
    size = std::max(size, std::abs(a.pixel[i]));
  }
  return largest / size;
}

}  // namespace

BOOST_AUTO_TEST_CASE(sources_of_all_pointings_are_found_and_their_model_explains_the_data) {
  const Pointings of;
  for (const char* const normtype : {"flatnoise", "flatsky"}) {
    const std::string name = normtype;
    succeed(of.image(name, {"--normtype", normtype, "--niter", "3000", "--threshold", "0.2mJy", "--nmajor", "12", "--pbcor",
                            "--verify", "50", "--savemodel", "modelcolumn"}));
    const json report = of.report(name);
    BOOST_TEST(report["error"]["measured_rms"].get<double>() <= 1e-5);
    BOOST_TEST(report["error"]["measured_predict_rms"].get<double>() <= 1e-5);
    const Image sky = of.pixels_of(name + ".image.pbcor"), beam = of.pixels_of(name + ".pb"),
                weight = of.pixels_of(name + ".weight"), model = of.pixels_of(name + ".model");
    double most = 0;
    for (const double w : weight.pixel) most = std::max(most, w);
    for (const Point& p : points) {
      BOOST_TEST(at(sky, p) == p.flux_jy, boost::test_tools::tolerance(2e-3));
      BOOST_TEST(at(beam, p) == std::sqrt(at(weight, p) / most), boost::test_tools::tolerance(1e-5));
      const double seen = name == "flatnoise" ? at(beam, p) : 1;
      BOOST_TEST(at(model, p) == p.flux_jy * seen, boost::test_tools::tolerance(5e-3));
    }
    const auto data = visibilities(of.set, "DATA"), saved = visibilities(of.set, "MODEL_DATA");
    double left = 0, all = 0;
    for (std::size_t i = 0; i < data.size(); ++i) left += std::norm(data[i] - saved[i]), all += std::norm(data[i]);
    BOOST_TEST(std::sqrt(left / all) < 3e-3);
  }
  // What predict makes of such a model is that of the sky, which dishes see: beams are cut off in the image alone.
  succeed(Arguments{"predict", "--vis", of.set, "--model", of.folder / "flatnoise.model.fits", "--apply-beam", "--beam", "airy",
                    "--column", "SKY"} +
          one_centre);
  const auto of_sky = visibilities(of.set, "SKY"), data = visibilities(of.set, "DATA");
  double left = 0, all = 0;
  for (std::size_t i = 0; i < data.size(); ++i) left += std::norm(data[i] - of_sky[i]), all += std::norm(data[i]);
  BOOST_TEST(std::sqrt(left / all) < 3e-3);
  // Both models are what CLEAN may begin with: of the sky, and of the sky times the beam.
  for (const char* const start : {"flatnoise", "flatsky"}) {
    succeed(of.image("again", {"--normtype", "flatnoise", "--niter", "1", "--startmodel",
                               of.folder / (std::string(start) + ".model.fits")}));
    BOOST_TEST(imager::largest_magnitude(of.pixels_of("again.residual")) < 5e-3);
  }
  BOOST_TEST(run(of.averaged("wide", {"--gridder", "wide", "--niter", "1", "--force-average", "--startmodel",
                                      of.folder / "flatnoise.model.fits"}))
                 .err.find("is the sky times a mosaic's primary beam") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(auto_makes_a_mosaic_of_fields_that_point_apart) {
  const Pointings of({"--noise", "1mJy"});
  const Outcome chosen = run(of.image("auto"));
  BOOST_TEST(chosen.err.find("fields point apart: --gridder mosaic") != std::string::npos, chosen.err);
  succeed(of.image("asked", {"--gridder", "mosaic", "--threads", "1"}));
  BOOST_TEST(
      (of.pixels_of("auto.residual").pixel.size() == static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels)));
  BOOST_TEST(difference(of.pixels_of("auto.residual"), of.pixels_of("asked.residual")) == 0);  // by any number of threads
  const Outcome averaged = run(of.averaged("averaged", {"--force-average"}));
  BOOST_TEST(averaged.code == 0);
  BOOST_TEST(averaged.err.find("averaged into one image") != std::string::npos, averaged.err);
  BOOST_TEST(!std::filesystem::exists(of.folder / "averaged.weight.fits"));
  if (!has_mpi()) return;
  succeed_together(3, of.image("together", {"--gridder", "mosaic"}));
  BOOST_TEST(difference(of.pixels_of("together.residual"), of.pixels_of("asked.residual")) < 1e-6);
  BOOST_TEST(difference(of.pixels_of("together.weight"), of.pixels_of("asked.weight")) < 1e-6);
}

/// One pointing has the image of a single field: its noise flattened, and its beam.
BOOST_AUTO_TEST_CASE(a_mosaic_of_one_pointing_is_the_image_of_its_field) {
  const Pointings of({}, "25");
  const Arguments one{"--field", "0", "--spw", "0:1"};
  succeed(of.image("mosaic", Arguments{"--gridder", "mosaic"} + one));
  succeed(of.image("field", Arguments{"--gridder", "wide"} + one));
  BOOST_TEST(difference(of.pixels_of("mosaic.pb"), of.pixels_of("field.pb")) < 1e-6);
  BOOST_TEST(difference(of.pixels_of("mosaic.residual"), of.pixels_of("field.residual")) < 1e-4);
}

BOOST_AUTO_TEST_CASE(planes_of_cubes_and_taylor_terms_keep_their_promise) {
  const Pointings of({"--noise", "1mJy"});
  const Arguments checked{"--gridder", "mosaic", "--verify", "40"};
  succeed(of.image("cube", checked + Arguments{"--specmode", "cube", "--outframe", "TOPO", "--niter", "50", "--pbcor"}));
  const json cube = of.report("cube");
  BOOST_TEST(cube["planes"].size() == 4);
  for (const json& plane : cube["planes"]) BOOST_TEST(plane["stokes"][0]["error"]["measured_rms"].get<double>() <= 1e-5);
  succeed(of.image("cube.one", {"--gridder", "mosaic", "--spw", "0:2", "--weighting", "briggs"}));
  succeed(of.image("cube.all", {"--gridder", "mosaic", "--specmode", "cube", "--outframe", "TOPO", "--weighting", "briggs"}));
  const Image plane = tools::open_image_file(of.folder / "cube.all.residual.fits")->read({2, 0});
  // Beams end where they do at the lowest frequency of a cube.
  BOOST_TEST(difference(plane, of.pixels_of("cube.one.residual")) < 3e-3);
  succeed(of.image("terms", checked + Arguments{"--nterms", "2", "--niter", "300", "--pbcor"}));
  BOOST_TEST(of.report("terms")["error"]["measured_rms"].get<double>() <= 1e-5);
  for (const char* const end : {"pb.tt0", "weight.tt0", "image.tt1.pbcor", "alpha.pbcor", "psf.tt2"})
    BOOST_TEST(std::filesystem::exists(of.folder / ("terms." + std::string(end) + ".fits")), end);
  BOOST_TEST(!std::filesystem::exists(of.folder / "terms.pb.tt1.fits"));
}

BOOST_AUTO_TEST_CASE(what_makes_no_mosaic_is_refused) {
  const Pointings of;
  const auto says = [&](const Arguments& arguments, const std::string& part) {
    const Outcome outcome = run(of.image("refused", Arguments{"--gridder", "mosaic"} + arguments));
    BOOST_TEST(outcome.code != 0);
    BOOST_TEST(outcome.err.find(part) != std::string::npos, outcome.err);
    BOOST_TEST(!std::filesystem::exists(of.folder / "refused.psf.fits"));
  };
  says({"--usepointing"}, "POINTING");
  says({"--beam-cut", "0"}, "--beam-cut 0: expected a number above 0");
  says({"--psfphasecenter", "J2000 65deg 40deg"}, "lies outside the image");
  const Outcome far = run(of.elsewhere("refused", {"--gridder", "mosaic", "--phasecenter", "J2000 80deg 40deg"}));
  BOOST_TEST(far.err.find("no pointing sees any pixel") != std::string::npos, far.err);
  says({"--check-outside"}, "check-outside");
  says({"--normtype", "pbsquare"}, "pbsquare");
}

BOOST_AUTO_TEST_SUITE_END()
