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
  model.unit = "JY/PIXEL";  // as WSClean writes it
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

BOOST_AUTO_TEST_CASE(points_and_gaussians_are_subtracted_from_the_data_that_they_made) {
  const TemporaryFolder folder;
  const std::string set = folder / "sky.ms", list = folder / "sky.csv";
  const std::string sources = "60,40,2,0\n60.0003,40.0002,3,0.5\n59.9998,39.9999,1,0.2\n";
  std::ofstream(list) << "ra_deg,dec_deg,flux_jy,scale_arcsec\n" << sources;
  succeed({"simulate", "--output", set, "--sky", list, "--channels", "5"});
  succeed({"predict", "--vis", set, "--components", list, "--subtract"});
  const Visibilities data = visibilities(set, "DATA"), left = visibilities(set, "CORRECTED_DATA");
  for (std::size_t i = 0; i < data.size(); ++i)
    BOOST_TEST(std::abs(left[i]) <= 6e-8F * std::abs(data[i]));  // 2^-24, the rounding of the data
  // Without their widths the same sources leave much: the wider one falls to a half at 180 of up to 480 thousand wavelengths.
  std::ofstream(list) << "ra_deg,dec_deg,flux_jy\n60,40,2\n60.0003,40.0002,3\n59.9998,39.9999,1\n";
  succeed({"predict", "--vis", set, "--components", list, "--subtract", "--column", "POINTS"});
  BOOST_TEST(rms(visibilities(set, "POINTS")) > 0.1 * rms(data));
}

BOOST_AUTO_TEST_CASE(what_subtraction_leaves_is_the_data_read_without_the_prediction) {
  const Copy copy;
  succeed(small_image(copy.set, copy.folder / "a") + Arguments{"--niter", "50"});
  const Arguments predict{"predict", "--vis", copy.set, "--model", copy.folder / "a.model.fits"};
  succeed(predict);
  succeed(predict + Arguments{"--subtract"});
  succeed(predict + Arguments{"--subtract", "--datacolumn", "corrected", "--column", "TWICE"});
  const Visibilities data = visibilities(copy.set, "DATA"), model = visibilities(copy.set, "MODEL_DATA");
  const Visibilities once = visibilities(copy.set, "CORRECTED_DATA"), twice = visibilities(copy.set, "TWICE");
  for (std::size_t i = 0; i < data.size(); ++i) {
    const float rounding = 2e-7F * (std::abs(data[i]) + std::abs(model[i]));  // three roundings of 2^-24
    BOOST_TEST(std::abs(data[i] - model[i] - once[i]) <= rounding);
    BOOST_TEST(std::abs(once[i] - model[i] - twice[i]) <= rounding);
  }
  BOOST_TEST((visibilities(snapshot(), "DATA") == data));
}

BOOST_AUTO_TEST_CASE(corrected_data_that_exist_are_overwritten_only_by_name) {
  const Copy copy;
  std::ofstream(copy.folder / "one.csv") << "l_arcsec,m_arcsec,flux_jy\n1,2,3\n";
  const Arguments predict{"predict", "--vis", copy.set, "--components", copy.folder / "one.csv"};
  succeed(predict + Arguments{"--column", "corrected"});
  const Visibilities before = visibilities(copy.set, "CORRECTED_DATA");
  BOOST_TEST(run(predict + Arguments{"--subtract"}).code == 1);
  BOOST_TEST((visibilities(copy.set, "CORRECTED_DATA") == before));
  succeed(predict + Arguments{"--subtract", "--column", "corrected"});
  BOOST_TEST((visibilities(copy.set, "CORRECTED_DATA") != before));
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
