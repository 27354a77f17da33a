// Masks that CLEAN makes, in whole runs: what it finds in them, against what it finds in masks drawn about the sources, and
// where their noise is measured.
#include <cmath>
#include <numeric>

#include "imager/clean/auto_mask.h"
#include "imager/data/noise.h"
#include "imager/direct/source_sums.h"
#include "imager/files/fits_image_reader.h"
#include "imager/numerics/constants.h"
#include "ms_io/simulated_set.h"
#include "tests/tools/program.h"
#include "tools/base/array.h"

BOOST_AUTO_TEST_SUITE(auto_mask_command)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;

constexpr int side = 256;                                  // pixels
constexpr double cell_rad = 10 * imager::pi / 180 / 3600;  // a fifth of the beam
constexpr double noise_jy = 1e-3;                          // of images with natural weights
constexpr double line_hz = 1.4e9, channel_hz = 1e5;

/// A source of the scene, placed and sized in pixels.
struct Drawn {
  int column;
  int row;
  double flux_jy;
  double fwhm = 0;  ///< pixels
};

using Scene = std::vector<std::vector<Drawn>>;  ///< [channel]

std::vector<imager::Source> sources_of(const std::vector<Drawn>& drawn) {
  std::vector<imager::Source> sources;
  for (const Drawn& d : drawn)
    sources.push_back({{(side / 2 - d.column) * cell_rad, (d.row - side / 2) * cell_rad}, d.flux_jy, d.fwhm * cell_rad});
  return sources;
}

/// Four hours of the VLA in its D configuration, with w = 0.
void write_set(const std::string& path, const Scene& scene, const std::string& telescope = "EVLA") {
  const tools::AntennaArray array = tools::antenna_array("vla-d");
  ms_io::SimulatedObservation o;
  o.telescope = telescope;
  o.antenna_name = array.name;
  o.antenna_itrf_m = array.itrf_m;
  o.fields.front().phase_centre = {1.0, 0.7, "FK5"};
  for (int i = -12; i < 12; ++i)
    o.time_mjd_s.push_back(tools::transit_mjd_s(array, o.fields.front().phase_centre, 4.5e9) + 600 * i);
  for (std::size_t c = 0; c < scene.size(); ++c) o.frequency_hz.push_back(line_hz + channel_hz * static_cast<double>(c));
  o.channel_width_hz = channel_hz;
  const std::size_t rows = array.name.size() * (array.name.size() - 1) / 2;
  o.noise_jy = noise_jy * std::sqrt(2.0 * static_cast<double>(rows * o.time_mjd_s.size()));  // Stokes I is the mean of two
  const auto coordinates = [&](std::size_t integration) {
    const double hour_angle = tools::hour_angle_rad(array, o.fields.front().phase_centre, o.time_mjd_s[integration]);
    std::vector<double> all = tools::uvw(array, {hour_angle, o.fields.front().phase_centre.dec_rad});
    for (std::size_t i = 2; i < all.size(); i += 3) all[i] = 0;
    return all;
  };
  const auto visibilities = [&](const imager::SampleCoordinates& at) {
    std::vector<std::complex<double>> all(at.samples());
    for (std::size_t c = 0; c < scene.size(); ++c) {
      const auto of_channel = imager::predict_sources(sources_of(scene[c]), {at.uvw_m, {at.frequency_hz[c]}}, 2, false);
      for (std::size_t row = 0; row < at.rows(); ++row) all[row * scene.size() + c] = of_channel[row];
    }
    return all;
  };
  ms_io::write_simulated_set(path, o, coordinates, visibilities, {});
}

/// Circles that hold all but a thousandth of each source's flux, and the main lobe beside.
std::string circles(const Scene& scene) {
  constexpr double beam = 5.5;  // pixels
  std::ostringstream text;
  text << "#CRTF\n";
  for (std::size_t channel = 0; channel < scene.size(); ++channel)
    for (const Drawn& d : scene[channel])
      text << "circle [[" << d.column << "pix, " << d.row << "pix], " << 1.6 * std::hypot(d.fwhm, beam) << "pix], range=["
           << channel << "chan, " << channel << "chan]\n";
  return text.str();
}

/// What CLEAN found of sources of one sign, each pixel counting for the source nearest to it.
double flux_of_sign(const imager::Image& model, const std::vector<Drawn>& sources, double sign) {
  double sum = 0;
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      const auto distance = [&](const Drawn& d) { return std::hypot(d.row - r, d.column - c) - d.fwhm; };
      const auto nearest = std::min_element(sources.begin(), sources.end(),
                                            [&](const Drawn& a, const Drawn& b) { return distance(a) < distance(b); });
      if (nearest->flux_jy * sign > 0) sum += model.at(r, c);
    }
  return sum;
}

double true_flux(const std::vector<Drawn>& sources, double sign) {
  double sum = 0;
  for (const Drawn& d : sources) sum += d.flux_jy * sign > 0 ? d.flux_jy : 0;
  return sum;
}

/// Runs both ways, and compares them channel by channel. CLEAN goes down to half the noise: that leaves 0.2 % of the true flux
/// in the residual, the noise itself shifts it by 0.4 %, and down to the noise CLEAN would leave 0.8 % in either mask.
void check_fluxes(const Scene& scene, const Arguments& options) {
  const TemporaryFolder folder;
  const std::string set = folder / "a.ms", automatic = folder / "auto", by_hand = folder / "hand", mask = folder / "hand.crtf";
  write_set(set, scene);
  std::ofstream(mask) << circles(scene);
  const auto cleaned = [&](const std::string& imagename, const Arguments& way) {
    Arguments command{"image",  "--vis",    set,       "--imagename", imagename,     "--imsize", std::to_string(side),
                      "--cell", "10arcsec", "--niter", "100000",      "--threshold", "0.5mJy"};
    if (scene.size() > 1) command = command + Arguments{"--specmode", "cube", "--outframe", "TOPO"};
    succeed(command + way);
    std::vector<imager::Image> models;
    const auto file = imager::open_fits_image(imagename + ".model.fits");
    for (int channel = 0; channel < static_cast<int>(scene.size()); ++channel) models.push_back(file->read({channel, 0}));
    return models;
  };
  const auto made = cleaned(automatic, Arguments{"--usemask", "auto-multithresh"} + options);
  const auto drawn = cleaned(by_hand, {"--mask", mask});
  const auto masks = imager::open_fits_image(automatic + ".mask.fits");
  for (std::size_t channel = 0; channel < scene.size(); ++channel) {
    const std::vector<Drawn>& sources = scene[channel];
    const auto total = [](const imager::Image& image) { return std::accumulate(image.pixel.begin(), image.pixel.end(), 0.0); };
    BOOST_TEST_CONTEXT("channel " << channel) {
      const double allowed = total(masks->read({static_cast<int>(channel), 0}));
      if (sources.empty()) {
        BOOST_TEST(allowed == 0);
        BOOST_TEST(total(made[channel]) == 0);
        continue;
      }
      BOOST_TEST(allowed < 0.1 * side * side);
      for (const double sign : {1.0, -1.0}) {
        const double truth = true_flux(sources, sign);
        if (truth == 0) continue;
        const double a = flux_of_sign(made[channel], sources, sign), h = flux_of_sign(drawn[channel], sources, sign);
        BOOST_TEST(std::abs(a / h - 1) < 0.01);
        BOOST_TEST(std::abs(a / truth - 1) < 0.01);
      }
    }
  }
}

}  // namespace

/// Points and Gaussians of 100 to 300 times the noise. The default thresholds are for compact arrays of many antennas, as this
/// is: its largest sidelobe is 0.14.
BOOST_AUTO_TEST_CASE(emission_has_the_flux_that_a_mask_by_hand_gives) {
  check_fluxes({{{100, 90, 0.3}, {180, 150, 0.1}, {60, 170, 1.5, 15}, {150, 60, 0.8, 9}}}, {});
}

/// By default there is no absorption; 7 is what ALMA's pipeline takes for lines on its longer baselines, with all else as by
/// default.
BOOST_AUTO_TEST_CASE(absorption_has_the_flux_that_a_mask_by_hand_gives) {
  check_fluxes({{{100, 90, 0.3}, {60, 170, 1.5, 15}, {125, 100, -0.3}, {150, 165, -1.2, 12}}}, {"--negativethreshold", "7"});
}

/// A line whose emission moves, and channels without any, by the default thresholds.
BOOST_AUTO_TEST_CASE(a_line_has_in_each_channel_the_flux_that_a_mask_by_hand_gives) {
  check_fluxes({{}, {{90, 120, 0.3}}, {{110, 125, 1.5, 14}, {170, 140, 0.2}}, {}, {{140, 130, 0.8, 9}}, {}}, {});
}

/// As tclean's documentation has it: outside the mask, of which there is none yet, and inside the primary beam. Sources fill
/// the image's edge with their sidelobes.
BOOST_AUTO_TEST_CASE(without_fastnoise_the_noise_of_masks_is_that_inside_the_primary_beam) {
  const TemporaryFolder folder;
  const std::string set = folder / "a.ms", station = folder / "b.ms";
  Scene scene(1);
  for (int i = 0; i < 30; ++i)
    scene[0].push_back({128 + static_cast<int>(110 * std::cos(i)), 128 + static_cast<int>(110 * std::sin(i)), 0.05});
  write_set(set, scene);
  write_set(station, scene, "LOFAR");
  const auto image = [&](const std::string& vis, const Arguments& options) {
    const std::string name = folder / "a";
    const Outcome outcome =
        run(Arguments{"image", "--vis", vis, "--imagename", name, "--imsize", std::to_string(side), "--cell", "10arcsec"} +
            options);
    BOOST_TEST_INFO(outcome.err);
    BOOST_TEST(outcome.code == 0);
    return name;
  };
  const auto noise_of_mask = [&](const std::string& vis, const Arguments& options) {
    const nlohmann::json report = report_of(image(
        vis, Arguments{"--niter", "1", "--usemask", "auto", "--fastnoise", "false", "--sidelobethreshold", "0"} + options));
    return report["clean"]["major_cycles_log"][0]["mask_extension"]["threshold_jy"].get<double>() / 5;
  };
  const auto within = [&](const std::string& limit) {
    imager::Image beam = pixels_of(image(set, {"--pblimit", limit}), "pb");
    for (double& pixel : beam.pixel) pixel = std::isnan(pixel) ? 0 : 1;
    return beam;
  };
  const imager::Image inner = within("0.7"), outer = within("0.2");
  const imager::Image dirty = pixels_of(folder / "a", "residual"), no_mask(side, side);
  const auto expected = [&](const imager::Image* where) { return imager::mask_noise(dirty, no_mask, where, 1); };
  BOOST_TEST(expected(&inner) < 0.9 * expected(&outer));
  BOOST_TEST(std::abs(expected(&outer) / expected(nullptr) - 1) > 0.05);
  const auto same = [](double a, double b) { return std::abs(a / b - 1) < 1e-5; };  // single precision of the image
  BOOST_TEST(same(noise_of_mask(set, {"--pblimit", "0.7"}), expected(&inner)));
  BOOST_TEST(same(noise_of_mask(set, {"--pblimit", "-0.7"}), expected(&inner)));
  BOOST_TEST(same(noise_of_mask(set, {"--pbmask", "0.7"}), expected(&inner)));
  BOOST_TEST(same(noise_of_mask(set, {}), expected(&outer)));
  BOOST_TEST(!std::filesystem::exists(folder / "a.pb.fits"));
  BOOST_TEST(same(noise_of_mask(station, {}), expected(nullptr)));
  BOOST_TEST(report_of(folder / "a")["warnings"].dump().find("masks have the noise of all of the image: LOFAR has no simple") !=
             std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
