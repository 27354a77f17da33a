// Frequencies that spectral axes of FITS images state, in whatever they count, and types of axes that are none.
#include "imager/files/fits_spectral.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "imager/files/fits_image_reader.h"
#include "tests/stated_fits.h"
#include "tests/temporary_folder.h"

BOOST_AUTO_TEST_SUITE(fits_spectral)

namespace {

using namespace misfit::imager;
using namespace misfit::testing;

constexpr double c_m_s = 299792458, line_hz = 1.42e9, first_hz = 1.405e9, step_hz = -2.5e5;

/// How an axis counts frequencies.
struct Kind {
  const char* type;
  const char* velref;
  double (*value)(double hz);
  bool in_frequency;  ///< whether its planes are evenly spaced in frequency
};

double radio(double hz) {
  return c_m_s * (1 - hz / line_hz);
}
double optical(double hz) {
  return c_m_s * (line_hz / hz - 1);
}
double relativistic(double hz) {
  const double square = hz / line_hz * (hz / line_hz);
  return c_m_s * (1 - square) / (1 + square);
}
double redshift(double hz) {
  return line_hz / hz - 1;
}
double wavelength(double hz) {
  return c_m_s / hz;
}
double frequency(double hz) {
  return hz;
}

const std::vector<Kind> kinds{
    {"FREQ", "", frequency, true},        {"FREQ-LSR", "", frequency, true},     {"VRAD", "", radio, true},
    {"VRAD-OBS", "", radio, true},        {"VELO-LSR", "257", radio, true},      {"VELO", "258", radio, true},
    {"VELO-LSR", "1", optical, false},    {"VELO-HEL", "", relativistic, false}, {"VELO", "", relativistic, false},
    {"VELO-F2V", "", relativistic, true}, {"VOPT", "", optical, false},          {"VOPT-F2W", "", optical, true},
    {"FELO-HEL", "", optical, true},      {"FELO-LSR", "257", radio, true},      {"ZOPT", "", redshift, false},
    {"ZOPT-F2W", "", redshift, true},     {"WAVE", "", wavelength, false},       {"WAVE-F2W", "", wavelength, true}};

/// CDELT3 that makes planes evenly spaced in frequency, to first order about `hz`.
double step_at(double hz, const Kind& kind) {
  constexpr double near_hz = 1e3;
  return (kind.value(hz + near_hz) - kind.value(hz - near_hz)) / (2 * near_hz) * step_hz;
}

/// The axis of so many planes whose pixel `reference`, counted from 1, lies at `hz`.
StatedCards cards_of(const Kind& kind, double hz, double reference) {
  return {{"CTYPE3", "'" + std::string(kind.type) + "'"}, {"CRPIX3", stated(reference)}, {"CRVAL3", stated(kind.value(hz))},
          {"CDELT3", stated(step_at(hz, kind))},          {"RESTFRQ", stated(line_hz)},  {"VELREF", kind.velref}};
}

ImageHeader read(const TemporaryFolder& folder, const StatedCards& cards, int planes) {
  write_stated_fits(folder / "a.fits", Image(3, 2), cards, planes);
  return open_fits_image(folder / "a.fits", Grids::any)->header();
}

std::string refusal_of(const TemporaryFolder& folder, const StatedCards& cards, int planes) {
  try {
    read(folder, cards, planes);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

BOOST_AUTO_TEST_CASE(one_plane_has_its_frequency_and_width_whatever_its_axis_counts) {
  const TemporaryFolder folder;
  for (const Kind& kind : kinds)
    for (const double hz : {0.7e9, first_hz, 1.45e9}) {
      const ImageHeader header = read(folder, cards_of(kind, hz, 1), 1);
      BOOST_TEST_CONTEXT(kind.type << " " << kind.velref) {
        // Steps are differences over 2 kHz of 1e9 Hz, to a few parts in 1e9.
        BOOST_TEST(std::abs(header.spectral.reference_hz / hz - 1) < 1e-14);
        BOOST_TEST(std::abs(header.spectral.increment_hz / step_hz - 1) < 1e-8);
        BOOST_TEST(header.observation.frequency_hz == header.spectral.reference_hz);
      }
    }
}

BOOST_AUTO_TEST_CASE(planes_evenly_spaced_in_frequency_or_wavelength_have_theirs_and_others_are_refused) {
  constexpr int planes = 7;
  constexpr double reference = 4;
  const TemporaryFolder folder;
  for (const Kind& kind : kinds) {
    const StatedCards cards = cards_of(kind, first_hz + (reference - 1) * step_hz, reference);
    const std::string part = std::string("its 7 planes of ") + kind.type + " are evenly spaced neither in frequency nor";
    const bool neither = !kind.in_frequency && kind.value == relativistic;
    BOOST_TEST(has(refusal_of(folder, cards, planes), part) == neither, kind.type);
    if (neither) continue;
    const SpectralAxis axis = read(folder, cards, planes).spectral;
    BOOST_TEST(axis.channels == planes);
    BOOST_TEST(axis.in_wavelength != kind.in_frequency);
    for (int plane = 0; plane < planes; ++plane) {
      if (kind.in_frequency) {
        BOOST_TEST(std::abs(axis.frequency_hz(plane) - first_hz - plane * step_hz) < 1e-7 * std::abs(step_hz), kind.type);
      } else {
        const double at = first_hz + (reference - 1) * step_hz, step = step_at(at, kind);
        const double value = kind.value(at) + (plane + 1 - reference) * step;
        BOOST_TEST(std::abs(kind.value(axis.frequency_hz(plane)) - value) < 1e-7 * std::abs(step), kind.type);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(frames_are_named_by_specsys_or_else_by_the_type_or_by_velref) {
  const TemporaryFolder folder;
  const Kind plain{"VRAD", "", radio, true}, named{"VRAD-OBS", "", radio, true}, numbered{"VRAD", "260", radio, true};
  BOOST_TEST(read(folder, cards_of(plain, first_hz, 1), 1).spectral.frame == "");
  BOOST_TEST(read(folder, cards_of(named, first_hz, 1), 1).spectral.frame == "TOPOCENT");
  BOOST_TEST(read(folder, cards_of(numbered, first_hz, 1), 1).spectral.frame == "LSRD");
  BOOST_TEST(read(folder, with(cards_of(named, first_hz, 1), {{"SPECSYS", "'LSRK'"}}), 1).spectral.frame == "LSRK");
}

BOOST_AUTO_TEST_CASE(axes_of_unknown_types_are_refused_by_name_though_they_have_one_plane) {
  const TemporaryFolder folder;
  const StatedCards axis{{"CRPIX3", "1"}, {"CRVAL3", "1"}, {"CDELT3", "1"}, {"RESTFRQ", "1.42E9"}};
  for (const char* type : {"NONSENSE", "VELO-XYZ", "VELOLSR", "VELOCITY", "FREQ-F2W", "VOPT-F2V", "AWAV", "ENER", "TIME", "RA",
                           "velo-lsr", "FREQ-"})
    for (const int planes : {1, 3}) {
      const std::string error = refusal_of(folder, with(axis, {{"CTYPE3", "'" + std::string(type) + "'"}}), planes);
      BOOST_TEST(has(error, "its axis 3 of type '" + std::string(type) + "' has length " + std::to_string(planes)), error);
      BOOST_TEST(has(error, "expected one STOKES axis, one of FREQ, VRAD, VELO"), error);
    }
  for (const char* type : {"", "'LINEAR'", "'PIXEL'"}) {
    BOOST_TEST(refusal_of(folder, with(axis, {{"CTYPE3", type}}), 1) == "", type);
    BOOST_TEST(has(refusal_of(folder, with(axis, {{"CTYPE3", type}}), 2), "has length 2"), type);
  }
}

BOOST_AUTO_TEST_CASE(velocities_without_a_line_or_in_unknown_units_are_refused) {
  const TemporaryFolder folder;
  for (const Kind& kind : kinds) {
    const StatedCards cards = cards_of(kind, first_hz, 1);
    const bool needs_line = kind.value != frequency && kind.value != wavelength;
    BOOST_TEST(has(refusal_of(folder, with(cards, {{"RESTFRQ", ""}}), 1), "axis has no RESTFRQ") == needs_line, kind.type);
    BOOST_TEST(has(refusal_of(folder, with(cards, {{"CUNIT3", "'furlong'"}}), 1), "has the unit furlong; expected"), kind.type);
  }
}

BOOST_AUTO_TEST_SUITE_END()
