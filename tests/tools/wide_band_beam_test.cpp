// Taylor terms and spectral indices without the primary beam, from a simulated set to files.
#include <array>
#include <cmath>

#include "imager/beams/airy_pattern.h"
#include "imager/numerics/constants.h"
#include "tests/tools/program.h"
#include "tools/run/product_kinds.h"

BOOST_AUTO_TEST_SUITE(wide_band_beam)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;

constexpr double reference_hz = 1.5e9, arcsec = imager::pi / 180 / 3600, cell_arcsec = 15;
constexpr int side = 128;
const std::string beam_name = "airy:25:2.36";

/// A source on a pixel, so many to the west and to the north of the middle.
struct Seen {
  int west, north;
  double flux_jy, alpha;

  int row() const { return side / 2 + north; }
  int column() const { return side / 2 + west; }
  double from(const imager::Image& image) const { return image.at(row(), column()); }
  /// What dishes as of the VLA, pointing to the middle, see of it at a frequency, in an Airy disc.
  double beam(double hz) const {
    const double sine = std::hypot(west, north) * cell_arcsec * arcsec;
    const double voltage = imager::airy_voltage({25, 2.36}, sine * hz / imager::speed_of_light_m_s);
    return voltage * voltage;
  }
  /// d ln beam / d ln frequency.
  double slope() const {
    return (std::log(beam(reference_hz * 1.001)) - std::log(beam(reference_hz * 0.999))) / std::log(1.001 / 0.999);
  }
};

/// Where the beam is 0.86, 0.5 and 0.3; and the spectral indices of the three by turns.
std::vector<Seen> sources(int turn) {
  constexpr std::array alpha{0.0, -0.7, 1.0};
  const auto index = [&](int place) { return alpha.at(static_cast<std::size_t>((place + turn) % 3)); };
  return {{20, 17, 1, index(0)}, {-46, -34, 2, index(1)}, {60, -43, 3, index(2)}};
}

/// A VLA in its D configuration that sees them, in 16 channels over so many MHz around 1.5 GHz.
void simulate_seen(const std::string& path, const std::vector<Seen>& sky, double bandwidth_mhz) {
  {
    std::ofstream list(path + ".csv");
    list << "l_arcsec,m_arcsec,flux_jy,spectral_index,reference_frequency_hz\n";
    for (const Seen& s : sky)
      list << -s.west * cell_arcsec << "," << s.north * cell_arcsec << "," << s.flux_jy << "," << s.alpha << "," << reference_hz
           << "\n";
  }
  const double width = bandwidth_mhz / 16;
  succeed({"simulate",
           "--output",
           path,
           "--sky",
           path + ".csv",
           "--array",
           "vla-d",
           "--primary-beam",
           "--beam",
           beam_name,
           "--frequency",
           std::to_string(1500 - 7.5 * width) + "MHz",
           "--channels",
           "16",
           "--channel-width",
           std::to_string(width) + "MHz",
           "--hours",
           "2",
           "--interval",
           "600"});
}

Arguments images(const std::string& vis, const std::string& imagename, const std::string& terms = "2") {
  return {"image",    "--vis", vis,       "--imagename", imagename,     "--imsize", "128",       "--cell", "15arcsec",
          "--nterms", terms,   "--niter", "20000",       "--threshold", "1mJy",     "--reffreq", "1.5GHz"};
}

bool exists(const std::string& imagename, const std::string& kind) {
  return std::filesystem::exists(imagename + "." + kind + ".fits");
}

/// Sources of turn 0, over a fifth of the frequency.
const std::string& seen_through_dishes() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    simulate_seen(folder / "seen.ms", sources(0), 300);
    return folder / "seen.ms";
  }();
  return path;
}

/// The images that there are for the beam of so many terms.
std::vector<std::string> beam_products(int terms, bool corrected) {
  std::vector<std::string> names =
      tools::product_names({.terms = terms, .cleaned = true, .primary_beam = true, .corrected = corrected});
  const std::vector<std::string> others = tools::product_names({.terms = terms, .cleaned = true});
  std::erase_if(names, [&](const std::string& name) { return std::count(others.begin(), others.end(), name) > 0; });
  return names;
}

}  // namespace

/// What two terms leave of a power law is a curve of α (α − 1)/2 x², at the band's edge 0.006 of the flux for −0.7, and 0 for 0
/// and 1: a third of it is added to the flux, and as much or, with weights that the beam changes, up to 1.2 times that to the
/// index. CLEAN to 1 mJy leaves a thousandth of the faintest source, divided by the beam and twice that of the index.
BOOST_AUTO_TEST_CASE(fluxes_and_indices_of_the_sky_are_those_of_its_sources_wherever_they_are_in_the_beam) {
  for (int turn = 0; turn < 3; ++turn) {
    const TemporaryFolder folder;
    const std::vector<Seen> sky = sources(turn);
    simulate_seen(folder / "seen.ms", sky, 300);
    succeed(images(folder / "seen.ms", folder / "a") + Arguments{"--pbcor", "--beam", beam_name});
    const auto pixels = [&](const std::string& kind) { return pixels_of(folder / "a", kind); };
    const imager::Image first = pixels("image.tt0.pbcor"), second = pixels("image.tt1.pbcor"), alpha = pixels("alpha.pbcor"),
                        apparent = pixels("alpha"), beam = pixels("pb.tt0"), slope = pixels("pb.tt1");
    for (const Seen& s : sky) {
      BOOST_TEST_CONTEXT("alpha " << s.alpha << " where the beam is " << s.beam(reference_hz)) {
        const double left = std::abs(s.alpha * (s.alpha - 1)) / 2 * 0.1 * 0.1;
        BOOST_TEST(std::abs(s.from(first) / s.flux_jy - 1) < left / 2 + 1e-3);
        BOOST_TEST(std::abs(s.from(second) / s.flux_jy - s.alpha) < 1.2 * left + 3e-3);
        BOOST_TEST(std::abs(s.from(alpha) - s.alpha) < 1.2 * left + 3e-3);
        // Two terms of a beam whose index is −3 differ by 0.03 from its derivative.
        BOOST_TEST(std::abs(s.from(apparent) - s.alpha - s.slope()) < 0.05);
        BOOST_TEST(std::abs(s.from(beam) / s.beam(reference_hz) - 1) < 0.01);
        BOOST_TEST(std::abs(s.from(slope) / s.from(beam) - s.slope()) < 0.05);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(three_terms_have_the_curvature_of_the_sky_too) {
  const TemporaryFolder folder;
  succeed(images(seen_through_dishes(), folder / "a", "3") + Arguments{"--pbcor", "--beam", beam_name});
  const imager::Image alpha = pixels_of(folder / "a", "alpha.pbcor"), beta = pixels_of(folder / "a", "beta.pbcor"),
                      apparent = pixels_of(folder / "a", "beta");
  for (const Seen& s : sources(0)) {
    BOOST_TEST(std::abs(s.from(alpha) - s.alpha) < 0.015);
    // Over ±0.1 a curvature of 0.05 is 2e-4 of the flux at the band's edge: what CLEAN leaves there.
    BOOST_TEST(std::abs(s.from(beta)) < 0.1);
    BOOST_TEST(std::abs(s.from(apparent)) > 0.2);  // of the beam
  }
}

/// The dirty images of one source are those of its Taylor terms in its own pixel: no CLEAN is needed.
BOOST_AUTO_TEST_CASE(dirty_images_are_corrected_as_the_principal_solution) {
  const TemporaryFolder folder;
  const Seen source{-46, -34, 2, 1};
  simulate_seen(folder / "seen.ms", {source}, 1000);
  for (const Arguments& weights : {Arguments{}, Arguments{"--weighting", "uniform"}}) {
    succeed(Arguments{"image", "--vis", folder / "seen.ms", "--imagename", folder / "a", "--imsize", "128", "--cell",
                      "15arcsec", "--nterms", "2", "--pbcor", "--beam", beam_name} +
            weights);
    // A power law of 1 is one of two terms. PSFs are right to 1e-4, of which the basis makes the coefficients.
    BOOST_TEST(std::abs(source.from(pixels_of(folder / "a", "image.tt0.pbcor")) / 2 - 1) < 2e-3);
    BOOST_TEST(std::abs(source.from(pixels_of(folder / "a", "image.tt1.pbcor")) / 2 - 1) < 2e-3);
    BOOST_TEST(!exists(folder / "a", "alpha.pbcor"));
  }
}

BOOST_AUTO_TEST_CASE(pixels_below_the_limit_and_pixels_without_an_index_have_none) {
  const TemporaryFolder folder;
  succeed(images(seen_through_dishes(), folder / "a", "3") + Arguments{"--pbcor", "--beam", beam_name, "--pblimit", "0.45"});
  const auto made = beam_products(3, true);
  const imager::Image beam = pixels_of(folder / "a", "pb.tt0"), apparent = pixels_of(folder / "a", "alpha");
  std::size_t without = 0;
  for (const double value : beam.pixel) {
    without += std::isnan(value);
    BOOST_TEST(!(value < 0.45 - 1e-6));
  }
  BOOST_TEST(without > beam.pixel.size() / 4);
  BOOST_TEST(without < beam.pixel.size());
  for (const std::string& kind : made) {
    const imager::Image image = pixels_of(folder / "a", kind);
    const bool index = kind == "alpha.pbcor" || kind == "beta.pbcor";
    for (std::size_t i = 0; i < image.pixel.size(); ++i)
      BOOST_REQUIRE(std::isnan(image.pixel[i]) == (std::isnan(beam.pixel[i]) || (index && std::isnan(apparent.pixel[i]))));
  }
  const std::vector<Seen> sky = sources(0);
  BOOST_TEST(!std::isnan(sky[1].from(pixels_of(folder / "a", "alpha.pbcor"))));  // at half power
  BOOST_TEST(std::isnan(sky[2].from(pixels_of(folder / "a", "alpha.pbcor"))));   // 0.3
  BOOST_TEST(!std::isnan(sky[2].from(apparent)));
}

BOOST_AUTO_TEST_CASE(files_are_those_that_are_asked_for_and_a_restart_makes_them) {
  const TemporaryFolder folder;
  const std::string name = folder / "a";
  const auto all = beam_products(3, true);
  const auto check = [&](const std::vector<std::string>& made) {
    for (const std::string& kind : all)
      BOOST_TEST(exists(name, kind) == (std::count(made.begin(), made.end(), kind) > 0), kind);
  };
  succeed(images(seen_through_dishes(), name, "3") + Arguments{"--pbcor", "--beam", beam_name});
  check(all);
  succeed(images(seen_through_dishes(), name) + Arguments{"--pblimit", "0.3"});
  check(beam_products(2, false));
  BOOST_TEST(run(images(seen_through_dishes(), name)).code == 0);
  check({});
  const imager::Image apparent = pixels_of(name, "alpha");
  succeed(images(seen_through_dishes(), name) + Arguments{"--restart", "--pbcor"});
  check(beam_products(2, true));
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  const auto again = pixels_of(name, "alpha").pixel;
  BOOST_TEST(std::equal(again.begin(), again.end(), apparent.pixel.begin(), apparent.pixel.end(), same));
}

BOOST_AUTO_TEST_CASE(headers_plan_and_run_say_which_index_is_whose) {
  const TemporaryFolder folder;
  Outcome outcome = run(images(seen_through_dishes(), folder / "a"));
  BOOST_TEST(outcome.err.find("--pbcor writes that of the sky, .alpha.pbcor") != std::string::npos, outcome.err);
  const auto has_card = [&](const std::string& kind, const std::string& keyword, const std::string& text) {
    const std::string header = content(folder / ("a." + kind + ".fits")).substr(0, 5760);
    const std::size_t card = header.find(keyword);
    return card != std::string::npos && header.substr(card, 80).find(text) != std::string::npos;
  };
  BOOST_TEST(has_card("alpha", "PBCOR ", "0. / the primary beam's spectrum is still in it"));
  BOOST_TEST(has_card("alpha", "ALPHALIM", "Jy/beam of .image.tt0"));
  BOOST_TEST(!has_card("image.tt0", "PBCOR ", ""));
  outcome = run(images(seen_through_dishes(), folder / "a") + Arguments{"--pbcor", "--beam", beam_name});
  BOOST_TEST(outcome.err.find(".alpha.pbcor is that of the sky") != std::string::npos, outcome.err);
  BOOST_TEST(has_card("alpha", "PBCOR ", "0. / the primary beam's spectrum is still in it"));
  BOOST_TEST(has_card("alpha.pbcor", "PBCOR ", "1. / the primary beam's spectrum is divided out"));
  BOOST_TEST(report_of(folder / "a")["plan"].dump().find(".alpha.pbcor is that of the sky") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
