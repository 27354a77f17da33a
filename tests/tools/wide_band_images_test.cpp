// Taylor terms and spectral indices, from a simulated set to files.
#include <cmath>

#include "imager/taylor/taylor_expansion.h"
#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"
#include "tools/run/product_kinds.h"

BOOST_AUTO_TEST_SUITE(wide_band_images)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;

/// 96 × 80 pixels of 0.1 arcsec: a steep source of 1 Jy to the north-east, a flat one of 0.6 Jy to the south-west.
struct Place {
  int row, column;
};
constexpr Place steep{60, 30}, flat{22, 70};
const char* const reference = "4GHz";

std::string sky_line(Place at, double flux_jy, double index) {
  std::ostringstream line;
  line << (48 - at.column) * 0.1 << "," << (at.row - 40) * 0.1 << "," << flux_jy << "," << index << ",4e9\n";
  return line.str();
}

Arguments simulation(const std::string& folder, const std::string& name) {
  const std::string list = folder + "sky.csv";
  std::ofstream(list) << "l_arcsec,m_arcsec,flux_jy,spectral_index,reference_frequency_hz\n"
                      << sky_line(steep, 1, -0.7) << sky_line(flat, 0.6, 0);
  return {"simulate", "--output", folder + name, "--sky", list,         "--coplanar",
          "--array",  "vla-a",    "--hours",     "1",     "--interval", "600"};
}

/// 20 % of bandwidth about 4 GHz in 8 channels, with noise of 1e-3 Jy in the image: 16 848 samples of two correlations.
const std::string& wide_band() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    const double noise_jy = 1e-3 * std::sqrt(2 * 351.0 * 6 * 8);
    succeed(simulation(folder / "", "band.ms") + Arguments{"--frequency", "3.65GHz", "--channels", "8", "--channel-width",
                                                           "100MHz", "--noise", std::to_string(noise_jy) + "Jy"});
    return folder / "band.ms";
  }();
  return path;
}

Arguments images(const std::string& imagename, const std::string& terms = "2") {
  return {"image",  "--vis",     wide_band(), "--imagename", imagename, "--imsize", "96",       "80",
          "--cell", "0.1arcsec", "--nterms",  terms,         "--niter", "5000",     "--nsigma", "4"};
}

bool exists(const std::string& imagename, const std::string& kind) {
  return std::filesystem::exists(imagename + "." + kind + ".fits");
}

double at(const imager::Image& image, Place place) {
  return image.at(place.row, place.column);
}

void check_refusal(const Arguments& arguments, int code, const std::string& part) {
  const Outcome outcome = run(arguments);
  BOOST_TEST(outcome.code == code);
  BOOST_TEST_INFO(outcome.err);
  BOOST_TEST(outcome.err.find(part) != std::string::npos);
  BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
}

}  // namespace

/// Noise of a thousandth of the steep source over channels that spread by 0.057 about ν_0 leaves 0.02 of its α to one standard
/// deviation, and 0.03 of the fainter source's: too much to judge the index itself by, which the next case does without noise.
BOOST_AUTO_TEST_CASE(the_spectral_index_is_right_within_three_times_its_error) {
  const TemporaryFolder folder;
  succeed(images(folder / "a"));
  const imager::Image alpha = pixels_of(folder / "a", "alpha"), error = pixels_of(folder / "a", "alpha.error");
  const imager::Image first = pixels_of(folder / "a", "image.tt0"), second = pixels_of(folder / "a", "image.tt1");
  BOOST_TEST(std::abs(at(alpha, steep) + 0.7) < 3 * at(error, steep));
  BOOST_TEST(std::abs(at(alpha, flat)) < 3 * at(error, flat));
  // σ_1/I_0 with σ_1 = 1e-3/√<x²>, to a tenth for noise measured in few beams, and what α² σ_0² adds.
  BOOST_TEST(std::abs(at(error, flat) / (1e-3 / 0.6 / 0.0573) - 1) < 0.25);
  std::size_t known = 0;
  for (std::size_t i = 0; i < alpha.pixel.size(); ++i) {
    if (std::isnan(alpha.pixel[i])) continue;
    ++known;
    BOOST_REQUIRE(std::abs(alpha.pixel[i] - second.pixel[i] / first.pixel[i]) < 1e-5 * (1 + std::abs(alpha.pixel[i])));
  }
  BOOST_TEST(known > 10U);                     // the sources
  BOOST_TEST(known < alpha.pixel.size() / 4);  // and no noise
}

/// Of a simulation without noise: what two terms make of the curve of −0.7 over 20 % is −0.702.
BOOST_AUTO_TEST_CASE(without_noise_the_index_is_right_to_a_hundredth) {
  const TemporaryFolder folder;
  succeed(simulation(folder / "", "exact.ms") +
          Arguments{"--frequency", "3.65GHz", "--channels", "8", "--channel-width", "100MHz"});
  for (const std::string terms : {"2", "3"}) {
    succeed({"image", "--vis", folder / "exact.ms", "--imagename", folder / "a", "--imsize", "96", "80", "--cell", "0.1arcsec",
             "--nterms", terms, "--niter", "20000", "--threshold", "1mJy", "--reffreq", reference});
    const imager::Image alpha = pixels_of(folder / "a", "alpha");
    BOOST_TEST(std::abs(at(alpha, steep) + 0.7) < 0.01);
    BOOST_TEST(std::abs(at(alpha, flat)) < 0.01);
    BOOST_TEST(imager::read_fits(folder / "a.image.tt0.fits").observation.frequency_hz == 4e9);
  }
}

BOOST_AUTO_TEST_CASE(files_are_those_of_the_terms_and_no_others_stay) {
  const TemporaryFolder folder;
  const auto all = tools::product_names({.terms = 3, .cleaned = true});
  for (const std::string terms : {"3", "2", "1"}) {
    succeed(images(folder / "a", terms));
    const auto made = tools::product_names({.terms = std::stoi(terms), .cleaned = true});
    for (const std::string& kind : all)
      BOOST_TEST(exists(folder / "a", kind) == (std::count(made.begin(), made.end(), kind) > 0));
    for (const char* kind : {"psf", "residual", "model", "image"}) BOOST_TEST(exists(folder / "a", kind) == (terms == "1"));
  }
}

BOOST_AUTO_TEST_CASE(the_beam_that_is_common_to_one_channel_is_the_fitted_one) {
  const TemporaryFolder folder;
  for (const std::string terms : {"1", "2"}) {
    const Arguments corrected{"--pbcor"};
    succeed(images(folder / "own", terms) + corrected);
    succeed(images(folder / "common", terms) + corrected + Arguments{"--restoringbeam", "common"});
    for (const std::string kind : {"image", "image.pbcor"}) {
      const std::string name = terms == "1" ? kind : kind == "image" ? "image.tt1" : "image.tt1.pbcor";
      BOOST_TEST((pixels_of(folder / "own", name).pixel == pixels_of(folder / "common", name).pixel), name);
    }
    BOOST_TEST(report_of(folder / "common")["beam"] == report_of(folder / "own")["beam"]);
  }
}

/// Those of .tt0 are the dirty image and the PSF of one term.
BOOST_AUTO_TEST_CASE(without_clean_there_are_dirty_images_and_psfs) {
  const TemporaryFolder folder;
  const auto dirty = [&](const std::string& name, const std::string& terms) {
    succeed({"image", "--vis", wide_band(), "--imagename", folder / name, "--imsize", "96", "80", "--cell", "0.1arcsec",
             "--nterms", terms});
  };
  dirty("one", "1");
  dirty("two", "2");
  BOOST_TEST((pixels_of(folder / "one", "residual").pixel == pixels_of(folder / "two", "residual.tt0").pixel));
  BOOST_TEST((pixels_of(folder / "one", "psf").pixel == pixels_of(folder / "two", "psf.tt0").pixel));
  for (const std::string& kind : tools::product_names({.terms = 2})) BOOST_TEST(exists(folder / "two", kind));
  BOOST_TEST(!exists(folder / "two", "image.tt0"));
  // Channels at ±50, ±150, … MHz from 4 GHz: <x²> = 0.00328125.
  BOOST_TEST(std::abs(pixels_of(folder / "two", "psf.tt2").at(40, 48) / 0.00328125 - 1) < 1e-4);
}

BOOST_AUTO_TEST_CASE(a_run_that_was_cut_goes_on_to_the_same_bits) {
  const TemporaryFolder folder;
  succeed(images(folder / "whole"));
  succeed(images(folder / "cut") + Arguments{"--nmajor", "1"});
  succeed(images(folder / "cut") + Arguments{"--restart"});
  for (const char* kind : {"image.tt0", "image.tt1", "model.tt1", "residual.tt1", "alpha"}) {
    const auto is = pixels_of(folder / "cut", kind).pixel, should = pixels_of(folder / "whole", kind).pixel;
    BOOST_TEST((std::equal(is.begin(), is.end(), should.begin(), should.end(),
                           [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); })));
  }
}

/// Deep without noise, model and data differ by what is left in the residuals: a thousandth of the sources, spread over
/// samples.
BOOST_AUTO_TEST_CASE(the_models_visibilities_are_those_of_its_spectra) {
  const TemporaryFolder folder;
  const std::string set = folder / "exact.ms";
  succeed(simulation(folder / "", "exact.ms") +
          Arguments{"--frequency", "3.65GHz", "--channels", "8", "--channel-width", "100MHz"});
  succeed({"image", "--vis", set, "--imagename", folder / "a", "--imsize", "96", "80", "--cell", "0.1arcsec", "--nterms", "2",
           "--niter", "20000", "--threshold", "1mJy", "--savemodel", "modelcolumn"});
  const auto data = visibilities(set, "DATA"), model = visibilities(set, "MODEL_DATA");
  BOOST_REQUIRE(data.size() == model.size());
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    difference += std::norm(data[i] - model[i]);
    norm += std::norm(data[i]);
  }
  // A flat model would miss (1 − (ν/ν_0)^−0.7) of the steep source, 4 % of all.
  BOOST_TEST(std::sqrt(difference / norm) < 0.01);
}

BOOST_AUTO_TEST_CASE(what_makes_no_sense_is_refused_in_a_line) {
  const TemporaryFolder folder;
  const Arguments scene{"image", "--vis", wide_band(), "--imagename", folder / "a", "--imsize", "64", "--cell", "0.1arcsec"};
  check_refusal(scene + Arguments{"--nterms", "4"}, 2, "--nterms 4: expected 1 to 3");
  check_refusal(scene + Arguments{"--nterms", "2", "--stokes", "IQ"}, 2, "--nterms 2: expected --stokes of one");
  check_refusal(scene + Arguments{"--reffreq", "4GHz"}, 2, "--reffreq 4GHz: expected --nterms 2 or 3");
  check_refusal(scene + Arguments{"--nterms", "2", "--reffreq", "4Gh"}, 2, "--reffreq 4Gh: expected a frequency");
  // Before any sample is read: a dry run reads none.
  check_refusal(small_image(snapshot(), folder / "b") + Arguments{"--nterms", "2", "--dry-run"}, 1,
                "--nterms 2: the channels selected have one frequency, 4 GHz; expected 2 or more, or fewer terms");
}

BOOST_AUTO_TEST_SUITE_END()
