#include "imager/beams/telescopes.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "imager/beams/airy_pattern.h"
#include "imager/beams/primary_beam.h"
#include "imager/numerics/constants.h"

BOOST_AUTO_TEST_SUITE(telescopes)

using namespace misfit::imager;

namespace {

/// Half-power width times frequency, arcmin · GHz.
double width(const BeamModel& model, double hz) {
  return PrimaryBeam({{model.pattern, model.pattern, hz, 1}}).half_power_width_rad() * hz / 1e9 * 180 * 60 / pi;
}

std::string refusal(const AntennaSort& antennas) {
  try {
    beam_model(antennas);
  } catch (const NoSimpleBeam& error) {
    return error.what();
  }
  return "";
}

}  // namespace

/// Widths published apart from the coefficients: of the VLA about 42, of GMRT's bands 5 and 3 23′ at 1.4 GHz and 75′ at 0.4 GHz
/// (NCRA), of ATCA 47.9 to 50.6 and of WSRT 49.87 and 51.54 (MIRIAD's list), of MeerKAT 57.5′ at 1.5 GHz (Mauch et al. 2020),
/// of ASKAP 1.09 λ/12 m, of ALMA's 12 m dishes 1.13 λ/D (technical handbook), of SMA 52.3″ at 224 GHz.
BOOST_AUTO_TEST_CASE(beams_are_as_wide_as_measured) {
  constexpr double per_m = speed_of_light_m_s / 1e9 * 180 * 60 / pi;  // λ/m in arcmin · GHz
  for (const double hz : {1.5e9, 3e9, 6e9, 10e9, 15e9, 22e9, 33e9, 43e9})
    BOOST_TEST(std::abs(width(beam_model({"EVLA", 25}), hz) / 42 - 1) < 0.04, hz);
  BOOST_TEST(std::abs(width(beam_model({"GMRT", 45}), 1.4e9) / (23 * 1.4) - 1) < 0.03);
  BOOST_TEST(std::abs(width(beam_model({"GMRT", 45}), 0.4e9) / (75 * 0.4) - 1) < 0.03);
  BOOST_TEST(std::abs(width(beam_model({"ATCA", 22}), 1.4e9) / 47.9 - 1) < 0.02);
  BOOST_TEST(std::abs(width(beam_model({"ATCA", 22}), 4.8e9) / 48.3 - 1) < 0.015);
  BOOST_TEST(std::abs(width(beam_model({"ATCA", 22}), 8.64e9) / 50.6 - 1) < 0.015);
  BOOST_TEST(std::abs(width(beam_model({"WSRT", 25}), 1.4e9) / 49.87 - 1) < 0.0005);
  BOOST_TEST(std::abs(width(beam_model({"WSRT", 25}), 0.35e9) / 51.54 - 1) < 0.0005);
  BOOST_TEST(std::abs(width(beam_model({"MeerKAT", 13.5}), 1.5e9) / 86.25 - 1) < 0.001);
  BOOST_TEST(std::abs(width(beam_model({"ASKAP", 12}), 1e9) / (1.09 * per_m / 12) - 1) < 1e-9);
  BOOST_TEST(std::abs(width(beam_model({"ALMA", 12}), 100e9) / (1.13 * per_m / 12) - 1) < 0.02);
  BOOST_TEST(std::abs(width(beam_model({"ALMA", 7}), 100e9) / (1.13 * per_m / 7) - 1) < 0.02);
  BOOST_TEST(std::abs(width(beam_model({"SMA", 6}), 224e9) / (52.3 / 60 * 224) - 1) < 0.001);
  BOOST_TEST(beam_model({"VLA", 25}).doubt_at(1.4e9) == "");
  BOOST_TEST(beam_model({"VLA", 25}).doubt_at(74e6).find("VLA was not fitted at 74 MHz") != std::string::npos);
  BOOST_TEST(beam_model({"ASKAP", 12}).doubt_at(1e9).find("formed") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(sorts_of_dishes_are_told_apart_by_their_diameter) {
  BOOST_TEST(beam_model({"ALMA", 12}).pattern != beam_model({"ALMA", 7}).pattern);
  BOOST_TEST(beam_model({"aca", 7.0}).pattern == beam_model({"ALMA", 7}).pattern);
  // A telescope's own dish where the set does not say how large it is, but not where it may be either of two …
  BOOST_TEST(beam_model({"EVLA", 0}).pattern == beam_model({"VLA", 25}).pattern);
  BOOST_TEST(refusal({"ALMA", 0, "DA41"}) ==
             "no primary beam is known of ALMA, and antenna 'DA41' has a DISH_DIAMETER of 0 m; expected 0.5 m to 500 m");
  // … and none of its own where the set says otherwise.
  BOOST_TEST(beam_model({"VLA", 100}).because.find("100 m from the column DISH_DIAMETER") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(dishes_that_are_not_known_are_taken_from_the_set_and_doubted) {
  const BeamModel model = beam_model({"VLBA", 25});
  for (const double sine : {0.0, 1e-3, 5e-3})
    BOOST_TEST(model.pattern->voltage(sine, 1e9) == airy_voltage({25, 0}, sine * 1e9 / speed_of_light_m_s));
  BOOST_TEST(model.because == "VLBA: 25 m from the column DISH_DIAMETER, uniformly lit");
  BOOST_TEST(model.doubt.find("VLBA's dishes of 25 m is not known") != std::string::npos);
  BOOST_TEST(beam_model({"", 3}).because.find("a telescope without a name") == 0U);
}

BOOST_AUTO_TEST_CASE(a_beam_by_name_takes_the_place_of_the_antennas_own) {
  const AntennaSort station{"LOFAR", 31.26, "CS001"};
  BOOST_TEST(named_beam("gmrt", station).pattern == beam_model({"GMRT", 45}).pattern);
  BOOST_TEST(beam_model({"uGMRT", 45}).pattern == beam_model({"GMRT", 45}).pattern);
  BOOST_TEST(named_beam("aca", station).pattern == beam_model({"ACA", 7}).pattern);
  BOOST_TEST(named_beam("alma", station).pattern == beam_model({"ALMA", 12}).pattern);
  BOOST_TEST(named_beam("Alma", {"ALMA", 7}).pattern == beam_model({"ALMA", 7}).pattern);
  const auto is_airy = [&](const std::string& name, const Dish& dish) {
    return named_beam(name, station).pattern->voltage(0.01, 1e9) == airy_voltage(dish, 0.01 * 1e9 / speed_of_light_m_s);
  };
  BOOST_TEST(is_airy("airy", {31.26, 0}));
  BOOST_TEST(is_airy("airy:25", {25, 0}));
  BOOST_TEST(is_airy("airy:25.5:2.36", {25.5, 2.36}));
  for (const char* wrong : {"", "./vla", "alma.fits", "none", "airy:", "airy:x", "airy:25:", "airy:25:25", "airy:-3",
                            "airy:25;3", "airy:25:3:1", "airy:0"}) {
    BOOST_TEST(!is_beam_name(wrong), wrong);
    BOOST_CHECK_THROW(named_beam(wrong, station), std::invalid_argument);
  }
  BOOST_TEST(expected_beam_names().find("VLA, EVLA, JVLA, ALMA, ACA, GMRT, UGMRT, ATCA, WSRT, ASKAP, ") == 0U);
  BOOST_CHECK_THROW(named_beam("airy", {"NEW", 0, "A1"}), NoSimpleBeam);
}

BOOST_AUTO_TEST_CASE(antennas_without_a_simple_beam_are_refused_by_name) {
  BOOST_TEST(
      refusal({"LOFAR", 31.26}) ==
      "LOFAR has no simple primary beam: its stations are arrays of dipoles, whose beams change with direction, time and "
      "frequency; --beam gives one");
  for (const char* telescope :
       {"LOFAR", "MWA", "LWASV", "LWA1", "OVRO-LWA", "SKA1-LOW", "SKA-Low", "NenuFAR", "PAPER", "HERA", "CHIME", "AARTFAAC"})
    for (const double diameter_m : {25.0, 2.0, 0.0})  // sets of MWA and PAPER say 25 m
      BOOST_TEST(refusal({telescope, diameter_m}).find(std::string(telescope) + " has no simple primary beam") == 0U);
  for (const double absurd : {0.0, -1.0, 0.1, 1e4, std::nan(""), std::numeric_limits<double>::infinity()})
    BOOST_TEST(refusal({"NEW", absurd, "A1"}).find("no primary beam is known of NEW, and antenna 'A1'") == 0U);
}

BOOST_AUTO_TEST_SUITE_END()
