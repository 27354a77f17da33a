#include "imager/beams/telescopes.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "imager/numerics/constants.h"

BOOST_AUTO_TEST_SUITE(telescopes)

using namespace misfit::imager;

namespace {

/// Half-power width times frequency, arcmin · GHz.
double width(const AntennaSort& antennas) {
  const Dish dish = dish_model(antennas).dish;
  return PrimaryBeam({{dish, dish, 100e9, 1}}).half_power_width_rad() * 100 * 180 * 60 / pi;
}

std::string refusal(const AntennaSort& antennas) {
  try {
    dish_model(antennas);
  } catch (const NoSimpleBeam& error) {
    return error.what();
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(beams_are_as_wide_as_measured) {
  // Perley 2016 has 40.6 to 43.6 for the VLA; of ALMA's 12 m dishes the technical handbook says 1.13 λ/D, 97.1; fits to the
  // ATCA are 47.9 to 51.0; Mauch et al. 2020 have 86.25 for MeerKAT; Brogan 195.25 for the SMA, in CASA.
  BOOST_TEST(std::abs(width({"EVLA", 25}) - 42.2) < 0.1);
  BOOST_TEST(std::abs(width({"ALMA", 12}) / 97.1 - 1) < 0.02);
  BOOST_TEST(std::abs(width({"ALMA", 7}) / (97.1 * 12 / 7) - 1) < 0.02);
  BOOST_TEST(std::abs(width({"ATCA", 22}) / 48.0 - 1) < 0.01);
  BOOST_TEST(std::abs(width({"MeerKAT", 13.5}) / 86.25 - 1) < 0.001);
  BOOST_TEST(std::abs(width({"SMA", 6}) / 195.25 - 1) < 0.001);
  BOOST_TEST(dish_model({"VLA", 25}).doubt == "");
  BOOST_TEST(dish_model({"ASKAP", 12}).doubt.find("formed") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(sorts_of_dishes_are_told_apart_by_their_diameter) {
  BOOST_TEST(dish_model({"ALMA", 12}).dish.diameter_m == 10.7);
  BOOST_TEST(dish_model({"ALMA", 7}).dish.diameter_m == 6.25);
  BOOST_TEST(dish_model({"aca", 7.0}).dish.diameter_m == 6.25);
  // A telescope's own dish where the set does not say how large it is, but not where it may be either of two …
  BOOST_TEST(dish_model({"EVLA", 0}).dish.diameter_m == 25.0);
  BOOST_TEST(refusal({"ALMA", 0, "DA41"}) ==
             "no primary beam is known of ALMA, and antenna 'DA41' has a DISH_DIAMETER of 0 m; expected 0.5 m to 500 m");
  // … and none of its own where the set says otherwise.
  BOOST_TEST(dish_model({"VLA", 100}).dish.diameter_m == 100.0);
}

BOOST_AUTO_TEST_CASE(dishes_that_are_not_known_are_taken_from_the_set_and_doubted) {
  const DishModel model = dish_model({"VLBA", 25});
  BOOST_TEST((model.dish == Dish{25, 0}));
  BOOST_TEST(model.because == "VLBA: 25 m from the column DISH_DIAMETER, uniformly lit");
  BOOST_TEST(model.doubt.find("VLBA's dishes of 25 m is not known") != std::string::npos);
  BOOST_TEST(dish_model({"", 3}).because.find("a telescope without a name") == 0U);
}

BOOST_AUTO_TEST_CASE(antennas_without_a_simple_beam_are_refused_by_name) {
  BOOST_TEST(
      refusal({"LOFAR", 31.26}) ==
      "LOFAR has no simple primary beam: its stations are arrays of dipoles, whose beams change with direction, time and "
      "frequency");
  for (const char* telescope :
       {"LOFAR", "MWA", "LWASV", "LWA1", "OVRO-LWA", "SKA1-LOW", "SKA-Low", "NenuFAR", "PAPER", "HERA", "CHIME", "AARTFAAC"})
    for (const double diameter_m : {25.0, 2.0, 0.0})  // sets of MWA and PAPER say 25 m
      BOOST_TEST(refusal({telescope, diameter_m}).find(std::string(telescope) + " has no simple primary beam") == 0U);
  for (const double absurd : {0.0, -1.0, 0.1, 1e4, std::nan(""), std::numeric_limits<double>::infinity()})
    BOOST_TEST(refusal({"NEW", absurd, "A1"}).find("no primary beam is known of NEW, and antenna 'A1'") == 0U);
}

BOOST_AUTO_TEST_SUITE_END()
