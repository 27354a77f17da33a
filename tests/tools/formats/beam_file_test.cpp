#include "tools/formats/beam_file.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>

#include "imager/numerics/constants.h"
#include "tests/observations.h"
#include "tests/tools/beam_files.h"

BOOST_AUTO_TEST_SUITE(beam_file)

using namespace misfit;
using namespace misfit::tools::testing;
using tools::BeamPixels;
using tools::read_beam_file;

namespace {

constexpr double degree = imager::pi / 180;

/// A skewed beam's voltage at angles to the east and north, in degrees.
double voltage(double east, double north) {
  return std::exp(-4 * east * east - 2 * north * north) * (1 + 0.4 * east + 0.2 * north);
}

std::string refusal(const std::string& path) {
  try {
    read_beam_file(path, BeamPixels::power);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(axes_count_as_their_cards_say) {
  const misfit::testing::TemporaryFolder folder;
  const std::string path = folder / "beam.fits";
  struct Axes {
    const char *type, *unit;
    double unit_degrees;  ///< size of the unit
    double east;          ///< sign of CDELT1
    bool sines;
  };
  for (const Axes& a :
       {Axes{"X", "deg", 1, 1, false}, Axes{"RA---SIN", "deg", 1, -1, true}, Axes{"AZ", "arcmin", 1.0 / 60, -1, false},
        Axes{"L", "", 1 / degree, -1, true}, Axes{"X", "rad", 1 / degree, 1, false}}) {
    BeamFile file;
    file.type = a.type;
    file.unit = a.unit;
    file.step = 0.02 / a.unit_degrees;
    file.east = a.east;
    write_beam_file(path, file, [&](double east, double north, double) {
      const double mirrored = a.type == std::string("AZ") ? -1 : 1;  // azimuths count to the west of a zenith in the north
      return std::pow(voltage(mirrored * east * a.unit_degrees, north * a.unit_degrees), 2);
    });
    const imager::Pattern pattern = read_beam_file(path, BeamPixels::power);
    for (const double east : {-0.4, 0.0, 0.3})
      for (const double north : {-0.5, 0.2}) {
        const double away = std::hypot(east, north) * degree;
        const double is = pattern->voltage_at(a.sines ? away : std::sin(away), std::atan2(east, north), 1.4e9);
        BOOST_TEST(std::abs(is - voltage(east, north)) < 1e-4, a.type);
      }
  }
}

BOOST_AUTO_TEST_CASE(a_cube_has_the_beam_of_its_frequencies_and_a_voltage_its_sign) {
  const misfit::testing::TemporaryFolder folder;
  BeamFile file;
  file.frequencies_hz = {1e9, 1.5e9, 2e9};
  const auto narrowing = [](double east, double north, double hz) {
    const double by = hz / 1e9;
    return voltage(by * east, by * north) * (1 - 3 * by * by * (east * east + north * north));  // negative beyond
  };
  write_beam_file(folder / "beam.fits", file, narrowing);
  const imager::Pattern pattern = read_beam_file(folder / "beam.fits", BeamPixels::voltage);
  bool negative = false;
  for (const double hz : {1e9, 1.2e9, 1.5e9, 2e9})
    for (const double east : {0.0, 0.3, 0.45}) {
      const double is = pattern->voltage_at(std::sin(std::hypot(east, 0.2) * degree), std::atan2(east, 0.2), hz);
      BOOST_TEST(std::abs(is - narrowing(east, 0.2, hz)) < 2e-3, hz);
      negative = negative || is < -0.01;
    }
  BOOST_TEST(negative);
  file.frequency_unit = "GHz";
  for (double& at : file.frequencies_hz) at /= 1e9;
  write_beam_file(folder / "beam.fits", file,
                  [&](double east, double north, double ghz) { return narrowing(east, north, 1e9 * ghz); });
  const imager::Pattern same = read_beam_file(folder / "beam.fits", BeamPixels::voltage);
  BOOST_TEST(std::abs(same->voltage_at(0.005, 1, 1.2e9) - pattern->voltage_at(0.005, 1, 1.2e9)) < 1e-9);
  BOOST_TEST(pattern->doubt(1.5e9) == "");
  BOOST_TEST(pattern->doubt(4e9).find("1000 to 2000 MHz") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(what_is_no_beam_is_refused_by_name) {
  const misfit::testing::TemporaryFolder folder;
  const std::string path = folder / "beam.fits";
  const auto refused = [&](const std::function<void(BeamFile&)>& change, double by = 1) {
    BeamFile file;
    change(file);
    write_beam_file(path, file, [by](double east, double north, double) { return by * std::pow(voltage(east, north), 2); });
    const std::string said = refusal(path);
    BOOST_TEST(said.find(path) != std::string::npos, said);
    return said;
  };
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  BOOST_TEST(has(refused([](BeamFile& f) { f.unit = "pixel"; }), "CUNIT1 is 'pixel'; expected deg"));
  BOOST_TEST(
      has(refused([](BeamFile& f) { f.frequencies_hz = {}; }), "it states no frequency; expected an axis FREQ, or RESTFRQ"));
  BOOST_TEST(has(refused([](BeamFile& f) { f.frequencies_hz = {-1e9}; }), "its frequencies include −1e+09 Hz"));
  BOOST_TEST(has(refused([](BeamFile&) {}, 0.8), "on its axis, at the reference pixel, it is 0.8 at 1.4 GHz; expected 1"));
  BOOST_TEST(has(refused([](BeamFile& f) { f.reference = 500; }), "whose axis is at"));
  BOOST_TEST(has(refused([](BeamFile& f) { f.step = 0; }), "CDELT1 and CDELT2"));
  BOOST_TEST(has(refused([](BeamFile& f) { f.frequency_unit = "furlong"; }), "CUNIT3 is 'furlong'; expected Hz"));
  BOOST_TEST(has(refused([](BeamFile& f) { f.rotation = 30; }), "CROTA2 is 30; expected axes that are not turned"));
  BOOST_TEST(has(refused([](BeamFile& f) { f.type = "GLON"; }), "CTYPE1 is 'GLON'; expected RA, X, L or AZ"));
  BOOST_TEST(has(refused([](BeamFile& f) {
                   f.frequencies_hz = {1e9, 1e9};
                 }),
                 "CDELT3 is 0; expected the step of 2 frequencies"));
  BOOST_TEST(has(refused([](BeamFile&) {}, 3), "it has a pixel of "));
  BOOST_TEST(has(refusal(folder / "none.fits"), "none.fits"));
}

BOOST_AUTO_TEST_SUITE_END()
