// From a model to visibilities, and back to an image.
#include <array>
#include <cstring>

#include "tests/moving_fields.h"
#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(predict_command)

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

BOOST_AUTO_TEST_CASE(a_list_without_sources_is_warned_of_and_one_without_columns_refused) {
  const Copy copy;
  const std::string list = copy.folder / "none.csv";
  const Arguments predict{"predict", "--vis", copy.set, "--components", list};
  std::ofstream(list) << "# nothing\n";
  const Outcome refused = run(predict);
  BOOST_TEST(refused.code == 1);
  BOOST_TEST(refused.err.find("none.csv, line 1: the list ends before a line that names its columns") != std::string::npos);
  std::ofstream(list) << "l_arcsec,m_arcsec,flux_jy\n";
  const Outcome warned = run(predict);
  BOOST_TEST(warned.code == 0);
  BOOST_TEST(warned.err.find("warning: " + list + " lists no source: all visibilities written are 0") != std::string::npos);
  BOOST_TEST(rms(visibilities(copy.set, "MODEL_DATA")) == 0);
  const Outcome subtracted = run(predict + Arguments{"--subtract"});
  BOOST_TEST(subtracted.err.find("lists no source: the data are written as they are") != std::string::npos);
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
  const Arguments subtract = predict + Arguments{"--subtract"};
  for (const Arguments& unnamed : {Arguments{}, Arguments{"--column", "corrected"}, Arguments{"--datacolumn", "data"}}) {
    const Outcome refused = run(subtract + unnamed);
    BOOST_TEST(refused.code == 1);
    BOOST_TEST(refused.err.find(
                   "has a column CORRECTED_DATA already; expected --column RESIDUAL_DATA, which leaves it as it is, or "
                   "--column CORRECTED_DATA --datacolumn corrected, which subtracts from it in place") != std::string::npos);
  }
  BOOST_TEST((visibilities(copy.set, "CORRECTED_DATA") == before));
  succeed(subtract + Arguments{"--column", "corrected", "--datacolumn", "data"});
  BOOST_TEST((visibilities(copy.set, "CORRECTED_DATA") != before));
}

BOOST_AUTO_TEST_CASE(subtraction_in_place_is_that_into_another_column_and_refused_a_second_time) {
  const Copy copy;
  std::ofstream(copy.folder / "one.csv") << "l_arcsec,m_arcsec,flux_jy\n1,2,3\n";
  const Arguments predict{"predict", "--vis", copy.set, "--components", copy.folder / "one.csv"};
  std::ofstream(copy.folder / "other.csv") << "l_arcsec,m_arcsec,flux_jy\n-1,1,2\n";
  succeed({"predict", "--vis", copy.set, "--components", copy.folder / "other.csv", "--column", "CORRECTED_DATA"});
  succeed(predict + Arguments{"--subtract", "--datacolumn", "corrected", "--column", "BESIDE"});
  const Arguments in_place = predict + Arguments{"--subtract", "--datacolumn", "corrected", "--column", "CORRECTED_DATA"};
  succeed(in_place);
  BOOST_TEST((visibilities(copy.set, "CORRECTED_DATA") == visibilities(copy.set, "BESIDE")));
  const Outcome second = run(in_place);
  BOOST_TEST(second.code == 1);
  BOOST_TEST(second.err.find(" has already been subtracted from CORRECTED_DATA of " + copy.set) != std::string::npos);
  BOOST_TEST((visibilities(copy.set, "CORRECTED_DATA") == visibilities(copy.set, "BESIDE")));
}

BOOST_AUTO_TEST_CASE(data_that_are_not_calibrated_are_subtracted_from_with_a_warning_where_there_are_calibrated_ones) {
  const Copy copy;
  std::ofstream(copy.folder / "one.csv") << "l_arcsec,m_arcsec,flux_jy\n1,2,3\n";
  const Arguments predict{"predict", "--vis", copy.set, "--components", copy.folder / "one.csv"};
  const Arguments subtract = predict + Arguments{"--subtract", "--column", "REST"};
  const auto warned = [](const Outcome& outcome) {
    return outcome.err.find("has CORRECTED_DATA, which misfit image takes, but the model is subtracted from DATA") !=
           std::string::npos;
  };
  BOOST_TEST(!warned(run(subtract)));
  succeed(predict + Arguments{"--column", "corrected"});
  const Outcome of_data = run(predict + Arguments{"--subtract", "--column", "OTHER"});
  BOOST_TEST(warned(of_data));
  BOOST_TEST(of_data.out.find("DATA − model of 351 visibilities in 351 rows written to OTHER") != std::string::npos,
             of_data.out);
  const Outcome of_corrected = run(subtract + Arguments{"--datacolumn", "corrected"});
  BOOST_TEST(!warned(of_corrected));
  BOOST_TEST(of_corrected.out.find(": CORRECTED_DATA − model of 351 visibilities") != std::string::npos, of_corrected.out);
  BOOST_TEST(!warned(run(subtract + Arguments{"--datacolumn", "data"})));
}

BOOST_AUTO_TEST_CASE(rows_and_channels_that_are_not_selected_are_told_of) {
  const TemporaryFolder folder;
  const std::string set = folder / "five.ms";
  succeed({"simulate", "--output", set, "--channels", "5"});
  std::ofstream(folder / "one.csv") << "l_arcsec,m_arcsec,flux_jy\n1,2,3\n";
  const Arguments predict{"predict", "--vis", set, "--components", folder / "one.csv"}, some{"--antenna", "!0"};
  const auto told = [&](const Arguments& options, const std::string& sentence) {
    const Outcome outcome = run(predict + options);
    BOOST_TEST(outcome.err.find("warning: " + sentence + "\n") != std::string::npos, outcome.err);
    return outcome.out;
  };
  const std::string rows = "26 of 351 rows";  // 26 of 27 · 26 / 2 baselines
  const std::string out = told(some, rows + " of " + set + " are not selected: MODEL_DATA is 0 there");
  BOOST_TEST(out.find("model of 1 625 visibilities in 325 of 351 rows written to MODEL_DATA") != std::string::npos, out);
  told(some, rows + " of " + set + " are not selected: MODEL_DATA keeps there what it held before");
  told(some + Arguments{"--subtract", "--column", "REST"}, rows + " of " + set + " are not selected: REST is DATA there");
  told(some + Arguments{"--spw", "0:1~2", "--column", "A"},
       rows + ", and channels of the others, of " + set + " are not selected: A is 0 there");
  told({"--spw", "0:1~2", "--column", "B"}, "channels of " + set + " are not selected: B is 0 there");
  BOOST_TEST(run(predict).err.find("not selected") == std::string::npos);
  BOOST_TEST(run(predict + Arguments{"--spw", "0"}).err.find("not selected") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_model_is_known_again_whatever_its_accuracy_or_the_order_of_its_sources) {
  const Copy copy;
  succeed(small_image(copy.set, copy.folder / "a") + Arguments{"--niter", "5"});
  std::ofstream(copy.folder / "one.csv") << "l_arcsec,m_arcsec,flux_jy\n1,2,3\n-1,1,2\n";
  std::ofstream(copy.folder / "other.csv") << "l_arcsec,m_arcsec,flux_jy\n-1,1,2\n1,2,3\n";
  const Arguments predict{"predict", "--vis", copy.set, "--subtract"};
  const Arguments in_place{"--datacolumn", "corrected", "--column", "CORRECTED_DATA"};
  succeed(predict + Arguments{"--model", copy.folder / "a.model.fits"});
  succeed(predict + in_place + Arguments{"--components", copy.folder / "one.csv"});
  for (const Arguments& again : {Arguments{"--model", copy.folder / "a.model.fits", "--accuracy", "1e-3"},
                                 {"--model", copy.folder / "a.model.fits", "--kernel", "spheroidal", "--accuracy", "1e-2"},
                                 {"--components", copy.folder / "other.csv"}}) {
    const Outcome outcome = run(predict + in_place + again);
    BOOST_TEST(outcome.code == 1);
    BOOST_TEST(outcome.err.find("has already been subtracted from") != std::string::npos, outcome.err);
  }
}

BOOST_AUTO_TEST_CASE(directions_on_the_sky_are_predicted_for_several_fields_each_about_its_own_centre) {
  const TemporaryFolder folder;
  const std::string set = folder / "two.ms";
  std::ofstream(folder / "none.csv") << "l_arcsec,m_arcsec,flux_jy\n0,0,0\n";
  succeed({"simulate", "--output", set, "--sky", folder / "none.csv", "--array", "vla-d", "--ra", "10deg", "--dec", "35deg",
           "--hours", "1", "--interval", "600"});
  misfit::testing::add_still_field(set, {11.5 * M_PI / 180, 36 * M_PI / 180});
  misfit::testing::put_fixed_source(set, {}, {10.2 * M_PI / 180, 35.1 * M_PI / 180}, 1);
  std::ofstream(folder / "fixed.csv") << "ra_deg,dec_deg,flux_jy\n10.2,35.1,1\n";
  succeed({"predict", "--vis", set, "--components", folder / "fixed.csv", "--subtract"});
  // The data and the difference are rounded to single precision.
  BOOST_TEST(rms(visibilities(set, "CORRECTED_DATA")) < 1e-6);
  std::ofstream(folder / "offsets.csv") << "l_arcsec,m_arcsec,flux_jy\n1,2,3\n";
  const Outcome offsets = run({"predict", "--vis", set, "--components", folder / "offsets.csv"});
  BOOST_TEST(offsets.code == 1);
  BOOST_TEST(offsets.err.find("select one with --field") != std::string::npos, offsets.err);
}

BOOST_AUTO_TEST_CASE(a_column_that_was_never_filled_is_told_of) {
  const Copy copy;
  scale_data(copy.set, 0);
  std::ofstream(copy.folder / "one.csv") << "l_arcsec,m_arcsec,flux_jy\n1,2,3\n";
  const Outcome subtracted = run({"predict", "--vis", copy.set, "--components", copy.folder / "one.csv", "--subtract"});
  BOOST_TEST(subtracted.code == 0);
  BOOST_TEST(subtracted.err.find("warning: all that was read of DATA of " + copy.set + " is 0: it was never filled") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(parts_of_a_model_that_no_correlation_sees_are_told_of) {
  const Copy copy;  // of XX and YY, which see I and Q
  const std::string list = copy.folder / "m.csv", fits = copy.folder / "m.fits";
  succeed(small_image(copy.set, copy.folder / "a"));
  imager::SkyImage model = imager::read_fits(copy.folder / "a.residual.fits");
  model.unit = "Jy/pixel";
  for (const imager::Stokes part : {imager::Stokes::I, imager::Stokes::Q, imager::Stokes::U, imager::Stokes::V}) {
    const std::string name = stokes_name(part);
    const bool seen = part == imager::Stokes::I || part == imager::Stokes::Q;
    std::ofstream(list) << "l_arcsec,m_arcsec,flux_jy,flux_q_jy,flux_u_jy,flux_v_jy\n1,1," << (name == "I") << ','
                        << (name == "Q") << ',' << (name == "U") << ',' << (name == "V") << '\n';
    model.stokes = part;
    imager::write_fits(model, fits, imager::PixelFormat::float32);
    for (const Arguments& source : {Arguments{"--components", list}, {"--model", fits}}) {
      const Outcome outcome = run(Arguments{"predict", "--vis", copy.set} + source);
      BOOST_TEST(outcome.code == 0);
      BOOST_TEST((outcome.err.find("responds to " + name + ": that of the model " + source[1] + " is left out") ==
                  std::string::npos) == seen,
                 outcome.err);
      BOOST_TEST((rms(visibilities(copy.set, "MODEL_DATA")) > 0) == seen);
    }
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

BOOST_AUTO_TEST_CASE(polarised_components_and_the_planes_of_a_model_image_are_the_same) {
  const Copy copy;
  std::ofstream(copy.folder / "two.csv")
      << "l_arcsec,m_arcsec,flux_jy,flux_q_jy,flux_v_jy\n1.2,-0.7,2,1.5,-0.5\n-2.1,1.4,1,-0.5,0\n";
  succeed(small_image(copy.set, copy.folder / "a") + Arguments{"--niter", "1"});
  const imager::SkyImage plane = imager::read_fits(copy.folder / "a.model.fits");
  const std::vector<std::array<float, 2>> fluxes = {{2, 1}, {1.5, -0.5}, {0, 0}, {-0.5, 0}};
  std::vector<imager::SkyImage> planes;
  for (std::size_t s = 0; s < fluxes.size(); ++s) {
    planes.push_back(plane);
    planes.back().stokes = static_cast<imager::Stokes>(s + 1);
    planes.back().image.pixel.assign(plane.image.pixel.size(), 0);
    planes.back().image.at(32 - 7, 32 - 12) = fluxes[s][0];
    planes.back().image.at(32 + 14, 32 + 21) = fluxes[s][1];
  }
  imager::write_fits(planes, copy.folder / "cube.fits", imager::PixelFormat::float32);
  succeed({"predict", "--vis", copy.set, "--model", copy.folder / "cube.fits"});
  succeed({"predict", "--vis", copy.set, "--components", copy.folder / "two.csv", "--column", "EXACT"});
  const Visibilities exact = visibilities(copy.set, "EXACT"), gridded = visibilities(copy.set, "MODEL_DATA");
  Visibilities difference, stokes_q;
  for (std::size_t i = 0; i < exact.size(); ++i) difference.push_back(gridded[i] - exact[i]);
  for (std::size_t i = 0; i < exact.size(); i += 2) stokes_q.push_back((exact[i] - exact[i + 1]) / 2.0F);
  BOOST_TEST(rms(difference) < (1e-6 + 1e-7) * rms(exact));  // the accuracy, and rounding to single precision
  BOOST_TEST(rms(stokes_q) > 1.0);                           // XX − YY = 2Q, of 1.5 and −0.5 Jy
  BOOST_TEST(rms(stokes_q) < 2.0);
  const Arguments start =
      small_image(copy.set, copy.folder / "b") + Arguments{"--startmodel", copy.folder / "cube.fits", "--niter", "9"};
  succeed(start);  // with the plane of I
  BOOST_TEST(run(start + Arguments{"--stokes", "XX"}).err.find("has no plane of XX, expected one of each in --stokes XX") !=
             std::string::npos);
  BOOST_TEST(run({"simulate", "--output", copy.folder / "no.ms", "--sky", copy.folder / "two.csv"}).err.find("'flux_q_jy'") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_prediction_that_was_stopped_says_so_and_goes_on) {
  const TemporaryFolder folder;
  const std::string set = folder / "many.ms", list = folder / "many.csv";
  succeed({"simulate", "--output", set, "--channels", "64", "--hours", "3", "--interval", "60"});
  std::ofstream text(list);
  text << "l_arcsec,m_arcsec,flux_jy\n";
#ifdef MISFIT_SANITIZED
  constexpr int sources = 20;
#else
  constexpr int sources = 100;  // enough for signals to come before the end
#endif
  for (int i = 0; i < sources; ++i) text << 0.01 * i << ',' << -0.02 * i << ",1\n";
  text.close();
  const Arguments predict{"predict", "--vis", set, "--components", list, "--threads", "1"};
  succeed(predict + Arguments{"--column", "WHOLE"});
  const std::string journal = set + "/misfit_unfinished_MODEL_DATA";
  for (const int signal : {SIGINT, SIGKILL}) {
    Child child(predict);
    while (!child.ended() && content(journal).find("\ndone 0 ") == std::string::npos)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    child.signal(signal);
    const int code = child.wait().code;
    BOOST_TEST_INFO(code);
    BOOST_TEST((code == (signal == SIGINT ? 130 : -SIGKILL) || code == 0));
    if (code == 0) continue;  // it was done before the signal came
    const Outcome image = run(small_image(set, folder / "a") + Arguments{"--datacolumn", "model", "--accuracy", "1e-3"});
    BOOST_TEST((image.err.find("warning: MODEL_DATA of " + set + " is incomplete: ") != std::string::npos));
    const Outcome rest = run(predict);
    BOOST_TEST(rest.code == 0);
    BOOST_TEST(
        (rest.err.find("rows were written before by misfit predict --components " + list + ", going on") != std::string::npos));
    BOOST_TEST((rest.out.find("of these rows had been written before") != std::string::npos));
    BOOST_TEST((visibilities(set, "MODEL_DATA") == visibilities(set, "WHOLE")));
    BOOST_TEST(!std::filesystem::exists(journal));
  }
}

BOOST_AUTO_TEST_CASE(correlations_without_stokes_i_are_predicted_all_the_same) {
  const misfit::testing::Unpacked data("bad_inputs");
  if (!data.present()) return;
  const std::string set = data / "bad_inputs/paper_xy_only.ms";
  std::ofstream(data / "one.csv") << "l_arcsec,m_arcsec,flux_jy,flux_u_jy\n0,0,3,2\n";
  succeed({"predict", "--vis", set, "--components", data / "one.csv"});
  for (const auto& value : visibilities(set, "MODEL_DATA")) BOOST_TEST(value == std::complex<float>(2));  // XY = U + iV
}

BOOST_AUTO_TEST_SUITE_END()
