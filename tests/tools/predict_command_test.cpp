// From a model to visibilities, and back to an image.
#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"

namespace {

using namespace misfit;
using namespace misfit::tools::testing;
using Visibilities = std::vector<std::complex<float>>;

/// A copy of the snapshot that a test may change.
struct Copy {
  TemporaryFolder folder;
  std::string set = folder / "copy.ms";
  Copy() { std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive); }
};

double rms(const Visibilities& values) {
  double square = 0;
  for (const auto& value : values) square += std::norm(value);
  return std::sqrt(square / static_cast<double>(values.size()));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(predict_command)

BOOST_AUTO_TEST_CASE(a_component_is_imaged_where_the_list_puts_it_in_each_quadrant) {
  const Copy copy;
  for (const auto& [l, m] : {std::pair(1.0, 2.0), {-1.5, 0.5}, {-0.5, -2.0}, {2.5, -1.0}}) {
    std::ofstream(copy.folder / "one.csv") << "l_arcsec,m_arcsec,flux_jy\n" << l << "," << m << ",3\n";
    succeed({"predict", "--vis", copy.set, "--components", copy.folder / "one.csv"});
    succeed(small_image(copy.set, copy.folder / "a") + Arguments{"--datacolumn", "model"});
    const imager::SkyImage sky = imager::read_fits(copy.folder / "a.residual.fits");
    const auto peak = std::max_element(sky.image.pixel.begin(), sky.image.pixel.end()) - sky.image.pixel.begin();
    BOOST_TEST(peak % 64 == 32 - std::lround(l / 0.1));
    BOOST_TEST(peak / 64 == 32 + std::lround(m / 0.1));
    // The set has w = 0 and weights alike, so the dirty image of a source on a pixel peaks at its flux, up to the accuracy
    // asked (1e-6 of the image) and the rounding of single-precision visibilities.
    BOOST_TEST(std::abs(sky.image.pixel[static_cast<std::size_t>(peak)] / 3 - 1) < 1e-5);
  }
}

BOOST_AUTO_TEST_CASE(data_minus_prediction_is_what_the_residual_image_shows) {
  const Copy copy;
  succeed(small_image(copy.set, copy.folder / "a") + Arguments{"--niter", "200", "--imsize", "128"});
  succeed({"predict", "--vis", copy.set, "--model", copy.folder / "a.model.fits"});
  const Visibilities data = visibilities(copy.set, "DATA"), model = visibilities(copy.set, "MODEL_DATA");
  BOOST_REQUIRE(data.size() == model.size());
  BOOST_TEST(rms(model) > 0.1 * rms(data));
  succeed(small_image(copy.set, copy.folder / "model") + Arguments{"--imsize", "128", "--datacolumn", "model"});
  succeed(small_image(copy.set, copy.folder / "data") + Arguments{"--imsize", "128"});
  const auto residual = imager::read_fits(copy.folder / "a.residual.fits").image.pixel;
  const auto of_model = imager::read_fits(copy.folder / "model.residual.fits").image.pixel;
  const auto of_data = imager::read_fits(copy.folder / "data.residual.fits").image.pixel;
  double error = 0, norm = 0;
  for (std::size_t i = 0; i < residual.size(); ++i) {
    error += std::pow(of_data[i] - of_model[i] - residual[i], 2);
    norm += std::pow(of_data[i], 2);
  }
  // Three images and one more prediction, each to 1e-6 of data of this size.
  BOOST_TEST(std::sqrt(error / norm) < 4e-6);
}

BOOST_AUTO_TEST_CASE(a_model_image_predicts_what_its_components_do) {
  const Copy copy;
  std::ofstream(copy.folder / "two.csv") << "l_arcsec,m_arcsec,flux_jy\n1.2,-0.7,2\n-2.1,1.4,1\n";
  succeed(small_image(copy.set, copy.folder / "a") + Arguments{"--niter", "1"});
  imager::SkyImage model = imager::read_fits(copy.folder / "a.model.fits");
  model.image.pixel.assign(model.image.pixel.size(), 0);
  model.image.at(32 - 7, 32 - 12) = 2;
  model.image.at(32 + 14, 32 + 21) = 1;
  imager::write_fits(model, copy.folder / "two.fits", imager::PixelFormat::float32);
  succeed({"predict", "--vis", copy.set, "--components", copy.folder / "two.csv", "--column", "CORRECTED_DATA"});
  for (const char* accuracy : {"1e-2", "1e-4", "1e-6"}) {
    succeed({"predict", "--vis", copy.set, "--model", copy.folder / "two.fits", "--accuracy", accuracy});
    const Visibilities exact = visibilities(copy.set, "CORRECTED_DATA"), gridded = visibilities(copy.set, "MODEL_DATA");
    Visibilities difference;
    for (std::size_t i = 0; i < exact.size(); ++i) difference.push_back(gridded[i] - exact[i]);
    // Stored as single precision, whose rounding is 6e-8 of each value.
    BOOST_TEST(rms(difference) < (std::stod(accuracy) + 1e-7) * rms(exact));
  }
}

BOOST_AUTO_TEST_CASE(only_the_column_asked_for_changes) {
  const Copy copy;
  std::ofstream(copy.folder / "one.csv") << "l_arcsec,m_arcsec,flux_jy\n1,2,3\n";
  const Visibilities data = visibilities(copy.set, "DATA");
  succeed({"predict", "--vis", copy.set, "--components", copy.folder / "one.csv", "--column", "PREDICTED"});
  BOOST_TEST((visibilities(copy.set, "DATA") == data));
  BOOST_TEST(visibilities(copy.set, "PREDICTED").size() == data.size());
}

BOOST_AUTO_TEST_SUITE_END()
