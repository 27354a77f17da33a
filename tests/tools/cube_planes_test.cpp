// What planes of a cube share and what they do not, by the program itself.
#include <cmath>
#include <complex>
#include <map>
#include <utility>

#include "imager/data/geometry.h"
#include "imager/files/fits_image_reader.h"
#include "imager/files/fits_image_writer.h"
#include "imager/numerics/constants.h"
#include "ms_io/simulated_set.h"
#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(cube_planes)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;

constexpr std::size_t baselines = 10, integrations = 3;
constexpr int rows = 30, channels = 4, size = 16;
constexpr double cell_rad = 20 * M_PI / 180 / 3600;
/// So far apart that a row's samples lie in cells of their own.
constexpr double first_hz = 1e9, channel_hz = 0.3e9;

double frequency_hz(int channel) {
  return first_hz + channel_hz * channel;
}

/// Of which integrations see the same baselines a little turned, so that some share a cell.
std::vector<double> uvw(std::size_t integration) {
  std::vector<double> all;
  for (std::size_t b = 0; b < baselines; ++b) {
    const double angle = 0.1 * static_cast<double>(integration) + 0.31 * static_cast<double>(b);
    const double length = 60 + 55 * static_cast<double>(b);
    all.insert(all.end(), {length * std::cos(angle), length * std::sin(angle), 0});
  }
  return all;
}

/// A point of 1 Jy in the phase centre.
std::string write_point(const TemporaryFolder& folder, const std::string& name) {
  ms_io::SimulatedObservation o;
  o.fields.front().phase_centre = {1.25, 0.3, "FK5"};
  for (int a = 0; a < 5; ++a) {
    o.antenna_name.push_back("A" + std::to_string(a));
    o.antenna_itrf_m.push_back({-1601185.4 + 90.0 * a * a, -5041977.5, 3554875.9});
  }
  for (std::size_t i = 0; i < integrations; ++i) o.time_mjd_s.push_back(4.9e9 + 600.0 * static_cast<double>(i));
  for (int c = 0; c < channels; ++c) o.frequency_hz.push_back(frequency_hz(c));
  o.channel_width_hz = channel_hz;
  const auto ones = [](const imager::SampleCoordinates& at) { return std::vector<std::complex<double>>(at.samples(), 1); };
  ms_io::write_simulated_set(folder / name, o, uvw, ones, {});
  return folder / name;
}

Arguments cube(const std::string& set, const std::string& imagename) {
  return {"image",  "--vis",    set,          "--imagename", imagename,    "--imsize", std::to_string(size),
          "--cell", "20arcsec", "--specmode", "cube",        "--outframe", "TOPO"};
}

imager::Image plane_of(const std::string& imagename, const std::string& kind, int plane) {
  return imager::open_fits_image(imagename + "." + kind + ".fits")->read({plane, 0});
}

/// [row] u and v of a channel's samples, wavelengths.
std::vector<std::pair<double, double>> uv(int channel) {
  std::vector<std::pair<double, double>> all;
  const double per_m = frequency_hz(channel) / imager::speed_of_light_m_s;
  for (std::size_t i = 0; i < integrations; ++i) {
    const std::vector<double> metres = uvw(i);
    for (std::size_t b = 0; b < baselines; ++b) all.emplace_back(metres[3 * b] * per_m, metres[3 * b + 1] * per_m);
  }
  return all;
}

/// Samples in cells of 1/(N cell), conjugates counted.
class Density {
 public:
  void add(int channel) {
    for (const auto& [u, v] : uv(channel)) {
      ++samples_[cell(u, v)];
      ++samples_[cell(-u, -v)];
    }
  }
  double at(double u, double v) const { return samples_.at(cell(u, v)); }

 private:
  static std::pair<double, double> cell(double u, double v) {
    return {std::floor(u * size * cell_rad), std::floor(v * size * cell_rad)};
  }
  std::map<std::pair<double, double>, double> samples_;
};

/// The PSF of uniform weights by its definition.
imager::Image direct_psf(int channel, const Density& density) {
  imager::Image psf(size, size);
  double weights = 0;
  for (const auto& [u, v] : uv(channel)) {
    const double weight = 1 / density.at(u, v);
    weights += weight;
    for (int r = 0; r < size; ++r)
      for (int c = 0; c < size; ++c)
        psf.at(r, c) += weight * std::cos(2 * M_PI * cell_rad * (u * (size / 2 - c) + v * (r - size / 2)));
  }
  for (double& pixel : psf.pixel) pixel /= weights;
  return psf;
}

/// 0 where both are NaN.
double largest_difference(const imager::Image& a, const imager::Image& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.pixel.size(); ++i)
    largest = std::isnan(a.pixel[i]) && std::isnan(b.pixel[i]) ? largest : std::max(std::abs(a.pixel[i] - b.pixel[i]), largest);
  return largest;
}

bool all_nan(const imager::Image& image) {
  return std::all_of(image.pixel.begin(), image.pixel.end(), [](double x) { return std::isnan(x); });
}

/// Whether one of a run's warnings begins so.
bool warned(const std::string& imagename, const std::string& begin) {
  const nlohmann::json warnings = report_of(imagename)["warnings"];
  BOOST_TEST_INFO(warnings.dump());
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const auto& w) { return w.template get<std::string>().starts_with(begin); });
}

}  // namespace

BOOST_AUTO_TEST_CASE(uniform_weights_follow_from_the_density_of_the_plane_or_of_all) {
  const TemporaryFolder folder;
  const std::string set = write_point(folder, "point");
  const Arguments uniform{"--weighting", "uniform"};
  succeed(cube(set, folder / "own") + uniform);
  succeed(cube(set, folder / "common") + uniform + Arguments{"--perchanweightdensity", "false"});
  Density common;
  for (int plane = 0; plane < channels; ++plane) common.add(plane);
  for (int plane = 0; plane < channels; ++plane) {
    Density own;
    own.add(plane);
    const imager::Image with_own = direct_psf(plane, own), with_common = direct_psf(plane, common);
    BOOST_TEST(largest_difference(with_own, with_common) > 0.02);
    // A PSF is made to 1e-4 of its root mean square, which pixels exceed by no more than √(16 · 16).
    BOOST_TEST(largest_difference(plane_of(folder / "own", "psf", plane), with_own) < 16e-4);
    BOOST_TEST(largest_difference(plane_of(folder / "common", "psf", plane), with_common) < 16e-4);
  }
}

BOOST_AUTO_TEST_CASE(a_plane_whose_psf_fits_no_beam_leaves_the_others_alone) {
  const TemporaryFolder folder;
  const std::string whole = write_point(folder, "whole"), spoilt = write_point(folder, "spoilt");
  for (const std::string& set : {whole, spoilt}) put_u(set, 0, 0);  // the origin: the first row has no v
  flag_channel(spoilt, 1, 1);                                       // so that the PSF is 1 everywhere
  for (const std::string beam : {"fitted", "common"}) {
    BOOST_TEST_CONTEXT(beam) {
      Arguments options{"--niter", "20"};
      if (beam == "common") options = options + Arguments{"--restoringbeam", "common"};
      succeed(cube(whole, folder / "a") + options);
      const Outcome outcome = run(cube(spoilt, folder / "b") + options);
      BOOST_TEST_INFO(outcome.err);
      BOOST_TEST_REQUIRE(outcome.code == 0);
      BOOST_TEST(warned(folder / "b", "plane 1: no beam can be fitted"));
      for (const int plane : {0, 2, 3})
        for (const std::string kind : {"psf", "residual", "model", "image"}) {
          // Of the beams that enclose several, a common one has the least area to a thousandth.
          const double tolerance = beam == "common" && kind == "image" ? 1e-3 : 0;
          BOOST_TEST(largest_difference(plane_of(folder / "a", kind, plane), plane_of(folder / "b", kind, plane)) <= tolerance);
        }
      BOOST_TEST(all_nan(plane_of(folder / "b", "image", 1)));
      BOOST_TEST(all_nan(plane_of(folder / "b", "model", 1)));
      BOOST_TEST(!all_nan(plane_of(folder / "b", "residual", 1)));
      for (int plane = 0; plane < channels; ++plane)
        BOOST_TEST(imager::open_fits_image(folder / "b.image.fits")->beam({plane, 0}).has_value() == (plane != 1));
      BOOST_TEST(report_of(folder / "b")["planes"][1]["beam"].is_null());
    }
  }
}

BOOST_AUTO_TEST_CASE(all_planes_that_a_mask_closes_are_named) {
  const TemporaryFolder folder;
  const std::string set = write_point(folder, "point"), path = folder / "mask.fits";
  const Arguments options{"--niter", "5"};
  succeed(cube(set, folder / "a") + options);
  imager::ImageHeader header = imager::open_fits_image(folder / "a.residual.fits")->header();
  header.cards.clear();
  const std::vector<std::pair<std::vector<int>, std::string>> closed{
      {{2}, "plane 2: "}, {{1, 3}, "planes 1 and 3: "}, {{0, 1, 2}, "planes 0 to 2: "}, {{0, 1, 2, 3}, "planes 0 to 3: "}};
  for (const auto& [planes, named] : closed) {
    const auto mask = imager::create_fits_image(header, path, imager::PixelFormat::float32);
    const auto is_closed = [&of = planes](int plane) { return std::find(of.begin(), of.end(), plane) != of.end(); };
    for (int plane = 0; plane < channels; ++plane) {
      imager::Image allowed(size, size);
      if (!is_closed(plane)) allowed.pixel.assign(allowed.pixel.size(), 1);
      mask->write({plane, 0}, allowed, std::nullopt);
    }
    mask->finish();
    const Outcome outcome = run(cube(set, folder / "b") + options + Arguments{"--mask", path});
    BOOST_TEST(outcome.code == 0);
    BOOST_TEST(warned(folder / "b", named + "the mask " + path + " allows no pixel of the image: nothing is cleaned"), named);
    const nlohmann::json report = report_of(folder / "b")["planes"];
    for (int plane = 0; plane < channels; ++plane)
      BOOST_TEST(report[static_cast<std::size_t>(plane)]["clean"]["iterations"] == (is_closed(plane) ? 0 : 5));
    std::filesystem::remove(path);
  }
}

BOOST_AUTO_TEST_CASE(planes_that_have_no_state_to_go_on_from_are_named) {
  const TemporaryFolder folder;
  const std::string set = write_point(folder, "point");
  succeed(cube(set, folder / "a") + Arguments{"--niter", "5"});
  for (const int plane : {0, 2}) std::filesystem::remove(folder / ("a.clean/" + std::to_string(plane) + ".state"));
  succeed(cube(set, folder / "a") + Arguments{"--niter", "7", "--restart"});
  BOOST_TEST(warned(folder / "a", "planes 0 and 2: there is no state in " + (folder / "a.clean") + " to go on from"));
}

BOOST_AUTO_TEST_CASE(regions_of_a_range_are_cleaned_in_its_planes_alone) {
  const TemporaryFolder folder;
  const std::string set = write_point(folder, "point"), mask = folder / "mask.crtf";
  std::ofstream(mask) << "#CRTF\nbox [[4pix, 4pix], [12pix, 12pix]], range=[1.2GHz, 1.7GHz]\n";  // planes 1 and 2
  BOOST_TEST(run(cube(set, folder / "a") + Arguments{"--niter", "5", "--mask", mask}).code == 0);
  const nlohmann::json planes = report_of(folder / "a")["planes"];
  for (std::size_t plane = 0; plane < channels; ++plane)
    BOOST_TEST(planes[plane]["clean"]["iterations"] == (plane == 1 || plane == 2 ? 5 : 0));
}

BOOST_AUTO_TEST_CASE(a_sample_is_counted_once) {
  const TemporaryFolder folder;
  const std::string set = write_point(folder, "point");
  flag_channel(set, 3, 20);
  for (int row = 0; row < 4; ++row) put_u(set, static_cast<std::size_t>(row), 1e4);  // beyond 1/(2 cell)
  // Planes of a quarter of a channel, planes of several, and some channels in none.
  for (const Arguments& planes :
       {Arguments{"--start", "1GHz", "--chanwidth", "0.075GHz", "--nchan", "12"},
        Arguments{"--start", "1", "--chanwidth", "2", "--nchan", "1"}, Arguments{"--start", "0", "--nchan", "4"}}) {
    for (const std::string interpolation : {"linear", "nearest"}) {
      const Outcome outcome = run(cube(set, folder / "a") + planes + Arguments{"--interpolation", interpolation});
      BOOST_TEST_INFO(outcome.err);
      BOOST_TEST_REQUIRE(outcome.code == 0);
      const nlohmann::json report = report_of(folder / "a"), counts = report["visibilities"];
      BOOST_TEST_CONTEXT(planes.back() << " planes, " << interpolation << ": " << counts.dump()) {
        const auto count = [&](const char* name) { return counts[name].get<std::int64_t>(); };
        const auto outside_planes = report["samples_outside_planes"].get<std::int64_t>();
        BOOST_TEST(count("samples_read") == rows * channels);
        BOOST_TEST(count("flagged") == 10);
        BOOST_TEST(count("outside_grid") > 0);
        BOOST_TEST(count("outside_grid") <= 4 * channels);
        BOOST_TEST(count("used") > 0);
        BOOST_TEST(count("used") + count("outside_grid") + count("flagged") + outside_planes == rows * channels);
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
