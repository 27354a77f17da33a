// One model predicted by misfit, by direct sums and by WSClean; skipped where that is not installed.
#include <random>

#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(wsclean_prediction)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;
using Visibilities = std::vector<std::complex<float>>;

bool installed() {
  const bool answers = Child({"--version"}, "wsclean").wait().code == 0;
  if (!answers) BOOST_TEST_MESSAGE("skipped: WSClean is not installed");
  return answers;
}

/// Points on pixels, as a list and as an image that WSClean finds.
struct Model {
  TemporaryFolder folder;
  std::string vis = folder / "noise.ms";

  Model(int pixels, double cell_arcsec, const Arguments& array) {
    std::ofstream(folder / "zero.csv") << "l_arcsec,m_arcsec,flux_jy\n0,0,0\n";
    succeed(Arguments{"simulate", "--output", vis, "--sky", folder / "zero.csv"} + array);
    succeed({"image", "--vis", vis, "--imagename", folder / "a", "--imsize", std::to_string(pixels), "--cell",
             std::to_string(cell_arcsec) + "arcsec", "--niter", "0", "--accuracy", "1e-3"});
    imager::SkyImage sky = imager::read_fits(folder / "a.residual.fits");
    sky.image.pixel.assign(sky.image.pixel.size(), 0);
    sky.unit = "Jy/pixel";
    std::ofstream list(folder / "points.csv");
    list.precision(17);
    list << "l_arcsec,m_arcsec,flux_jy\n";
    const double cell_rad = sky.geometry.cell_rad;
    std::mt19937 random(1);
    std::uniform_int_distribution<int> place(pixels / 50, pixels - pixels / 50);
    for (int point = 0; point < 1000; ++point) {  // enough that a transform is cheaper than their sum
      const int column = place(random), row = place(random), flux = 1 + point % 9;
      if (sky.image.at(row, column) != 0) continue;
      sky.image.at(row, column) = flux;
      const double arcsec = M_PI / 180 / 3600;
      list << (pixels / 2 - column) * cell_rad / arcsec << ',' << (row - pixels / 2) * cell_rad / arcsec << ',' << flux << '\n';
    }
    list.close();
    imager::write_fits(sky, folder / "m-model.fits", imager::PixelFormat::float64);
  }
};

/// ‖a − b‖ over ‖b‖, and the largest difference over the root mean square of b.
std::pair<double, double> differences(const Visibilities& a, const Visibilities& b) {
  BOOST_REQUIRE(a.size() == b.size());
  double square = 0, norm = 0, largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    square += std::norm(a[i] - b[i]);
    norm += std::norm(b[i]);
    largest = std::max<double>(largest, std::abs(a[i] - b[i]));
  }
  return {std::sqrt(square / norm), largest / std::sqrt(norm / static_cast<double>(b.size()))};
}

void compare(const Model& model) {
  succeed({"predict", "--vis", model.vis, "--model", model.folder / "m-model.fits", "--column", "OURS"});
  succeed({"predict", "--vis", model.vis, "--components", model.folder / "points.csv", "--column", "DIRECT"});
  const Visibilities ours = visibilities(model.vis, "OURS"), direct = visibilities(model.vis, "DIRECT");
  const auto [rms, largest] = differences(ours, direct);
  BOOST_TEST_MESSAGE("ours against direct sums: " << rms << ", largest " << largest);
  BOOST_TEST(rms > 0);            // not the same sums twice
  BOOST_TEST(rms < 1e-6 + 1e-7);  // the accuracy asked, and the rounding of two columns in single precision
  if (!installed()) return;
  const Outcome outcome = Child({"-use-wgridder", "-wgridder-accuracy", "1e-6", "-no-small-inversion", "-padding", "2",
                                 "-predict", "-name", model.folder / "m", model.vis},
                                "wsclean")
                              .wait();
  BOOST_REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  const auto [theirs_rms, theirs_largest] = differences(visibilities(model.vis, "MODEL_DATA"), ours);
  BOOST_TEST_MESSAGE("WSClean's against ours: " << theirs_rms << ", largest " << theirs_largest);
  BOOST_TEST(theirs_rms < 1e-4);  // what WSClean's prediction reaches
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_small_field_without_w_agrees) {
  compare(Model(256, 0.05, {"--coplanar", "--hours", "1", "--interval", "120", "--channels", "3"}));
}

BOOST_AUTO_TEST_CASE(a_wide_field_with_w_agrees) {
  compare(Model(512, 10, {"--noncoplanar", "--array", "vla-d", "--hours", "4", "--interval", "300", "--frequency", "1GHz"}));
}

BOOST_AUTO_TEST_SUITE_END()
