// The same samples in another order make the same image.
#include <cmath>

#include "imager/files/fits_image_reader.h"
#include "ms_io/simulated_set.h"
#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(sample_order)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;

constexpr std::size_t antennas = 6, baselines = 15, channels = 4;
constexpr double channel_hz = 2e6;

std::vector<double> uvw(std::size_t integration) {
  std::vector<double> all;
  for (std::size_t b = 0; b < baselines; ++b) {
    const double angle = 0.26 * static_cast<double>(integration) + 0.41 * static_cast<double>(b);
    const double length = 60 + 35 * static_cast<double>(b);
    all.insert(all.end(), {length * std::cos(angle), length * std::sin(angle), 0.1 * length});
  }
  return all;
}

/// Three points, seen on some days.
std::string write_set(const std::string& path, double first_hz, const std::vector<double>& days) {
  ms_io::SimulatedObservation o;
  o.fields.front().phase_centre = {1.25, 0.3, "FK5"};
  for (std::size_t a = 0; a < antennas; ++a) {
    o.antenna_name.push_back("A" + std::to_string(a));
    o.antenna_itrf_m.push_back({-1601185.4 + 90.0 * static_cast<double>(a * a), -5041977.5, 3554875.9});
  }
  for (const double day : days)
    for (int i = 0; i < 4; ++i) o.time_mjd_s.push_back(4.9e9 + day * 86400 + 600 * i);
  for (std::size_t c = 0; c < channels; ++c) o.frequency_hz.push_back(first_hz + channel_hz * static_cast<double>(c));
  o.channel_width_hz = channel_hz;
  const auto points = [](const imager::SampleCoordinates& at) {
    std::vector<std::complex<double>> sums;
    for (std::size_t r = 0; r < at.rows(); ++r)
      for (const double hz : at.frequency_hz) {
        const double turns = 2 * M_PI * hz / 299792458;
        const double u = turns * at.uvw_m[3 * r], v = turns * at.uvw_m[3 * r + 1];
        sums.push_back(2.0 + std::polar(1.0, 3e-4 * u - 2e-4 * v) + std::polar(0.5, -1e-4 * u - 4e-4 * v));
      }
    return sums;
  };
  ms_io::write_simulated_set(path, o, uvw, points, {});
  return path;
}

/// The images of a run, plane by plane, with where the planes lie.
struct Made {
  std::vector<std::vector<double>> planes;
  std::vector<double> frequency_hz;
};

Made made(const Arguments& sets, const Arguments& options, const std::string& imagename, const std::string& kind) {
  succeed(Arguments{"image", "--imagename", imagename, "--imsize", "32", "--cell", "20arcsec", "--vis"} + sets + options);
  const auto file = imager::open_fits_image(imagename + "." + kind + ".fits");
  Made images;
  for (int channel = 0; channel < file->header().spectral.channels; ++channel) {
    images.planes.push_back(file->read({channel, 0}).pixel);
    images.frequency_hz.push_back(file->header().spectral.frequency_hz(channel));
  }
  return images;
}

void check_same(const Made& one, const Made& two) {
  BOOST_TEST(one.frequency_hz == two.frequency_hz, boost::test_tools::per_element());
  BOOST_REQUIRE(one.planes.size() == two.planes.size());
  for (std::size_t p = 0; p < one.planes.size(); ++p) {
    double largest = 0, apart = 0;
    for (std::size_t k = 0; k < one.planes[p].size(); ++k) {
      const double a = one.planes[p][k], b = two.planes[p][k];
      BOOST_TEST(std::isnan(a) == std::isnan(b));
      largest = std::max(largest, std::isnan(a) ? 0 : std::abs(a));
      apart = std::max(apart, std::isnan(a) ? 0 : std::abs(a - b));
    }
    // Sums in single precision where 1e-6 is asked: 2^-24 of each of the terms, which add at random.
    BOOST_TEST(apart <= 1e-6 * largest);
  }
}

const std::vector<Arguments> ways{{"--niter", "0"},
                                  {"--weighting", "briggs", "--robust", "0"},
                                  {"--specmode", "cube"},
                                  {"--specmode", "cube", "--outframe", "BARY", "--chanwidth", "2"},
                                  {"--specmode", "cube", "--start", "1.402GHz", "--weighting", "uniform"}};

}  // namespace

BOOST_AUTO_TEST_CASE(rows_may_come_in_any_order) {
  const TemporaryFolder folder;
  const std::string set = write_set(folder / "a.ms", 1.4e9, {90, 0, 200});
  shuffle_rows(set, folder / "b.ms", 1);
  for (const Arguments& options : ways)
    check_same(made({set}, options, folder / "a", "residual"), made({folder / "b.ms"}, options, folder / "b", "residual"));
}

BOOST_AUTO_TEST_CASE(sets_may_come_in_any_order) {
  const TemporaryFolder folder;
  const std::string late = write_set(folder / "late.ms", 1.401e9, {150}), early = write_set(folder / "early.ms", 1.4e9, {0});
  for (const Arguments& options : ways)
    check_same(made({late, early}, options, folder / "a", "residual"), made({early, late}, options, folder / "b", "residual"));
}

BOOST_AUTO_TEST_CASE(windows_beside_the_planes_are_named_and_sets_that_are_not_read_do_not_count_as_empty) {
  const TemporaryFolder folder;
  const std::string low = write_set(folder / "low.ms", 1.4e9, {10}), high = write_set(folder / "high.ms", 1.45e9, {0});
  const Arguments cube{"image",  "--imagename", folder / "a", "--imsize", "16",
                       "--cell", "20arcsec",    "--specmode", "cube",     "--vis"};
  const Outcome outcome = run(cube + Arguments{low, high});
  BOOST_TEST(outcome.code == 0);
  BOOST_TEST(outcome.err.find("data outside the cube's planes") != std::string::npos, outcome.err);
  BOOST_TEST(outcome.err.find("spectral window 0 of " + low) != std::string::npos, outcome.err);
  BOOST_TEST(outcome.err.find("never filled") == std::string::npos, outcome.err);
  const Outcome gap = run(cube + Arguments{low, high, "--start", "1.42GHz", "--nchan", "2"});
  BOOST_TEST(gap.code == 2);
  BOOST_TEST(gap.err.find("hold no data: they lie between windows") != std::string::npos, gap.err);
}

BOOST_AUTO_TEST_SUITE_END()
