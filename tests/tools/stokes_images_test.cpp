// Images of Stokes parameters, from a model through correlations and back.
#include <cmath>

#include "imager/data/stokes.h"
#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(stokes_images)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;

/// A copy of the snapshot with other correlations.
struct Copy {
  TemporaryFolder folder;
  std::string set = folder / "copy.ms";

  explicit Copy(const std::vector<int>& types) {
    std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
    store_correlations(set, types);
  }
  void predict(const std::string& columns, const std::string& lines) const {
    std::ofstream(folder / "sky.csv") << "l_arcsec,m_arcsec," << columns << "\n" << lines;
    succeed({"predict", "--vis", set, "--components", folder / "sky.csv"});
  }
  std::vector<imager::SkyImage> images(const Arguments& options, const std::string& kind = "residual") const {
    succeed(small_image(set, folder / "a") + Arguments{"--datacolumn", "model"} + options);
    return imager::read_stokes_images(folder / ("a." + kind + ".fits"));
  }
};

const std::vector<int> linear = {9, 10, 11, 12}, circular = {5, 8, 6, 7};

/// Two polarised points.
const char* const stokes_columns = "flux_jy,flux_q_jy,flux_u_jy,flux_v_jy";
const char* const two_points = "-2,1,5,2,-1,0.5\n1.2,-0.5,3,-0.25,0.75,-1\n";

/// Their brightness as an image shows it.
std::string brightness(const std::string& stokes) {
  const std::map<std::string, std::array<double, 2>> of = {{"I", {5, 3}},    {"Q", {2, -0.25}}, {"U", {-1, 0.75}},
                                                           {"V", {0.5, -1}}, {"XX", {7, 2.75}}, {"YY", {3, 3.25}},
                                                           {"RR", {5.5, 2}}, {"LL", {4.5, 4}}};
  std::ostringstream lines;
  lines << "-2,1," << of.at(stokes)[0] << "\n1.2,-0.5," << of.at(stokes)[1] << "\n";
  return lines.str();
}

double relative_difference(const imager::Image& image, const imager::Image& from) {
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < image.pixel.size(); ++i) {
    difference += std::pow(image.pixel[i] - from.pixel[i], 2);
    norm += std::pow(from.pixel[i], 2);
  }
  return std::sqrt(difference / norm);
}

/// Each image to 1e-6, and visibilities that are rounded to single precision twice.
constexpr double of_two_images = 3e-6;

}  // namespace

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_AUTO_TEST_CASE(every_stokes_parameter_looks_like_an_unpolarised_sky_of_its_brightness) {
  for (const auto& [types, lists] : {std::pair(linear, Arguments{"IQUV", "V", "XXYY"}), {circular, {"IQUV", "QU", "LL"}}})
    for (const std::string& list : lists) {
      const Copy polarised(types), plain(linear);
      polarised.predict(stokes_columns, two_points);
      const std::vector<imager::SkyImage> planes = polarised.images({"--stokes", list});
      const std::vector<imager::Stokes> wanted = imager::parse_stokes(list);
      BOOST_TEST_REQUIRE(planes.size() == wanted.size());
      for (std::size_t s = 0; s < planes.size(); ++s) {
        const std::string name = imager::stokes_name(wanted[s]);
        BOOST_TEST_INFO(name);
        BOOST_TEST((planes[s].stokes == wanted[s]));
        plain.predict("flux_jy", brightness(name));
        BOOST_TEST(relative_difference(planes[s].image, plain.images({}).front().image) < of_two_images);
      }
      BOOST_TEST(polarised.images({"--stokes", list}, "psf").size() == 1U);
    }
}

BOOST_AUTO_TEST_CASE(clean_finds_the_points_in_each_stokes_parameter) {
  const Copy copy(circular);
  copy.predict(stokes_columns, two_points);
  const auto planes = copy.images({"--stokes", "IQUV", "--niter", "3000", "--threshold", "1mJy"}, "image");
  const nlohmann::json report = report_of(copy.folder / "a");
  BOOST_TEST_REQUIRE(planes.size() == 4U);
  BOOST_TEST_REQUIRE(report["stokes"].size() == 4U);
  const double fluxes[4][2] = {{5, 3}, {2, -0.25}, {-1, 0.75}, {0.5, -1}};
  for (std::size_t s = 0; s < 4; ++s) {
    // Both lie on pixels of 0.1 arcsec. Components of a point may spread over neighbours, where the beam is some percent lower:
    // half a percent of 5 Jy, and the threshold in some pixels.
    BOOST_TEST(std::abs(planes[s].image.at(32 + 10, 32 + 20) - fluxes[s][0]) < 0.03);
    BOOST_TEST(std::abs(planes[s].image.at(32 - 5, 32 - 12) - fluxes[s][1]) < 0.03);
    BOOST_TEST(report["stokes"][s]["stokes"] == imager::stokes_name(planes[s].stokes));
    BOOST_TEST(std::abs(report["stokes"][s]["clean"]["model_flux_jy"].get<double>() - fluxes[s][0] - fluxes[s][1]) < 0.02);
  }
  BOOST_TEST(report["clean"] == report["stokes"][0]["clean"]);
}

BOOST_AUTO_TEST_CASE(masks_of_each_stokes_parameter_are_made_and_taken_back) {
  const Copy copy(circular);
  copy.predict(stokes_columns, two_points);
  const Arguments clean{"--stokes", "IV", "--niter", "100"};
  const std::vector<imager::SkyImage> made = copy.images(clean + Arguments{"--usemask", "auto"}, "mask");
  BOOST_TEST_REQUIRE(made.size() == 2U);
  std::filesystem::rename(copy.folder / "a.mask.fits", copy.folder / "own.fits");
  const auto used = copy.images(clean + Arguments{"--mask", copy.folder / "own.fits"}, "mask");
  std::vector<imager::SkyImage> closed = made;
  closed[1].image = imager::Image(closed[1].image.width, closed[1].image.height);
  imager::write_fits(closed, copy.folder / "closed.fits", imager::PixelFormat::float32);
  copy.images(clean + Arguments{"--mask", copy.folder / "closed.fits"}, "residual");
  const std::string warnings = report_of(copy.folder / "a")["warnings"].dump();
  BOOST_TEST(warnings.find("closed.fits allows no pixel of the image of V, of which nothing is cleaned") != std::string::npos,
             warnings);
  for (std::size_t s = 0; s < 2; ++s) BOOST_TEST(used[s].image.pixel == made[s].image.pixel, boost::test_tools::per_element());
  const Outcome outcome =
      run(small_image(copy.set, copy.folder / "b") +
          Arguments{"--datacolumn", "model", "--niter", "9", "--stokes", "Q", "--mask", copy.folder / "own.fits"});
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST(outcome.err.find("has several planes but none of Q; expected one plane, or one of each of Q") !=
             std::string::npos);
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_AUTO_TEST_CASE(the_model_of_any_stokes_parameters_is_saved_as_all_correlations_show_it) {
  for (const char* stokes : {"V", "QU", "IQUV", "XX", "YY", "XXYY", "LL", "RRLL"}) {
    const bool is_circular = std::string(stokes).find_first_of("RL") != std::string::npos;
    const Copy copy(is_circular ? circular : linear);
    copy.predict(stokes_columns, two_points);
    succeed(small_image(copy.set, copy.folder / "a") +
            Arguments{"--datacolumn", "model", "--stokes", stokes, "--niter", "200", "--savemodel", "modelcolumn"});
    // The saved model's own image is that of the model's planes.
    for (const imager::SkyImage& plane : imager::read_stokes_images(copy.folder / "a.model.fits")) {
      const std::string name = imager::stokes_name(plane.stokes);
      double flux = 0;
      for (const double pixel : plane.image.pixel) flux += pixel;
      const Arguments one{"--datacolumn", "model", "--stokes", name, "--niter", "200", "--gain", "0.5"};
      succeed(small_image(copy.set, copy.folder / "b") + one);
      const double again = report_of(copy.folder / "b")["clean"]["model_flux_jy"];
      BOOST_TEST_INFO(stokes << " " << name);
      BOOST_TEST(std::abs(again - flux) < 0.02 * 5);  // two percent of the brightest point
    }
  }
}

BOOST_AUTO_TEST_CASE(what_is_saved_as_nothing_though_the_set_has_it_is_said) {
  struct Case {
    std::vector<int> types;
    std::string stokes, said;  ///< nothing where it is empty
  };
  const std::vector<int> hands{9, 12}, one_hand{5};
  for (const auto& [types, stokes, said] :
       {Case{linear, "I", ""}, Case{linear, "IQUV", ""}, Case{linear, "V", "of V alone: I, Q and U are 0 in MODEL_DATA"},
        Case{linear, "QU", "of Q and U alone: I and V are 0 in MODEL_DATA"}, Case{hands, "IQ", ""},
        Case{hands, "Q", "of Q alone: I is 0 in MODEL_DATA"}, Case{circular, "IV", "of I and V alone: Q and U are 0"},
        Case{hands, "XXYY", ""}, Case{linear, "XXYY", "of XX and YY alone: XY and YX are 0"},
        Case{hands, "XX", "of XX alone: YY is 0"}, Case{circular, "LL", "of LL alone: RR, RL and LR are 0"},
        Case{one_hand, "RR", ""}}) {
    const Copy copy(types);
    copy.predict(stokes_columns, two_points);
    const Outcome outcome =
        run(small_image(copy.set, copy.folder / "a") +
            Arguments{"--datacolumn", "model", "--niter", "5", "--savemodel", "modelcolumn", "--stokes", stokes});
    BOOST_TEST_CONTEXT(stokes << " " << outcome.err) {
      BOOST_TEST(outcome.code == 0);
      BOOST_TEST((outcome.err.find("writes the model of") != std::string::npos) == !said.empty());
      BOOST_TEST(outcome.err.find(said) != std::string::npos);
    }
  }
}

BOOST_AUTO_TEST_CASE(one_hand_is_saved_in_itself_alone) {
  const Copy copy(linear);
  copy.predict(stokes_columns, two_points);
  const Arguments image = small_image(copy.set, copy.folder / "a") +
                          Arguments{"--datacolumn", "model", "--niter", "20", "--savemodel", "modelcolumn", "--stokes"};
  BOOST_TEST(run(image + Arguments{"I,XX"}).err.find("or of parallel hands, such as XXYY or RR") != std::string::npos);
  BOOST_TEST(run(image + Arguments{"XX"}).code == 0);
  const auto model = visibilities(copy.set, "MODEL_DATA");
  for (std::size_t i = 0; i < model.size(); ++i)
    if (i % 4 != 0) BOOST_TEST(std::abs(model[i]) < 1e-6);  // of 7 Jy, rounded to single precision
}

BOOST_AUTO_TEST_CASE(what_cannot_be_formed_is_refused_with_the_correlations_there_are) {
  const Copy copy(std::vector<int>{9, 12});
  for (const auto& [stokes, expected] : {std::pair("V", "Stokes V cannot be formed from correlations XX, YY; it needs"),
                                         {"RR", "correlation RR is not among XX, YY"}}) {
    const Outcome outcome = run(small_image(copy.set, copy.folder / "a") + Arguments{"--stokes", stokes});
    BOOST_TEST(outcome.code == 1);
    BOOST_TEST(outcome.err.find(expected) != std::string::npos);
  }
  const Outcome outcome = run(small_image(copy.set, copy.folder / "a") + Arguments{"--stokes", "IXX"});
  BOOST_TEST(outcome.code == 0);
  for (const char* refused : {"IQV", "XY", "IX", "QQ"}) {
    const Outcome wrong = run(small_image(copy.set, copy.folder / "a") + Arguments{"--stokes", refused});
    BOOST_TEST(wrong.code == 2);
    BOOST_TEST(wrong.err.find(std::string("--stokes ") + refused + ": expected ") != std::string::npos);
  }
}

BOOST_AUTO_TEST_SUITE_END()
