#include "imager/beams/telescopes.h"

#include <array>
#include <cctype>
#include <cmath>
#include <sstream>

namespace misfit::imager {
namespace {

/// A sort of dishes of a telescope.
struct KnownDish {
  const char* telescope;
  double diameter_m;  ///< of the reflector, by which a telescope's sorts are told apart
  Dish dish;
  const char* source;
  const char* doubt = "";
};

constexpr char vla[] = "25 m with a blockage of 2.36 m, as CASA has its bands (measured: Perley 2016, EVLA Memo 195)";
constexpr char alma_12_m[] = "12 m dishes, as wide as 10.7 m with a blockage of 0.75 m (CASA, from Hunter & Brogan 2011)";
constexpr char alma_7_m[] = "7 m dishes, as wide as 6.25 m with a blockage of 0.75 m (CASA, from Hunter & Brogan 2011)";
constexpr char askap[] = "12 m, uniformly lit";
constexpr char formed_beams[] =
    "ASKAP's beams are formed from phased-array feeds, and only roughly those of its dishes: where measured ones are at hand "
    "(Hotan et al. 2021, PASA 38, e009), they are the ones to correct by";

// Widths are those between half-power points times the frequency, in arcmin · GHz.
const KnownDish known_dishes[] = {
    // 42.2; measured 40.6 to 43.6 from L to Q band.
    {"VLA", 25, {25, 2.36}, vla},
    {"EVLA", 25, {25, 2.36}, vla},
    {"JVLA", 25, {25, 2.36}, vla},
    // 98.8 and 168.3, that is 1.151 λ/12 m and 1.143 λ/7 m.
    {"ALMA", 12, {10.7, 0.75}, alma_12_m},
    {"ALMA", 7, {6.25, 0.75}, alma_7_m},
    {"ACA", 12, {10.7, 0.75}, alma_12_m},
    {"ACA", 7, {6.25, 0.75}, alma_7_m},
    // 48.2; by CASA's fits to measurements 47.9 at 1.3 GHz, 48.9 at 4.8 GHz, 51.0 at 8.6 GHz.
    {"ATCA", 22, {22, 0}, "22 m, uniformly lit, which is 1% (1.3 GHz) to 6% (8.6 GHz) narrower than measured (CASA's fits)"},
    {"ASKAP", 12, {12, 0}, askap, formed_beams},
    {"ASKAP36", 12, {12, 0}, askap, formed_beams},
    // 86.2; the subreflector stands beside the aperture.
    {"MEERKAT", 13.5, {12.3, 0}, "13.5 m, as wide as 12.3 m: 57.5′ at 1.5 GHz (Mauch et al. 2020, ApJ 888, 61)"},
    {"NGVLA", 18, {18, 0}, "18 m, uniformly lit (CASA)"},
    {"NOEMA", 15, {15, 1}, "15 m with a blockage of 1 m (CASA)"},
    {"IRAMPDB", 15, {15, 1}, "15 m with a blockage of 1 m (CASA)"},
    // 195.2
    {"SMA", 6, {5.43, 0}, "6 m, as wide as 5.43 m: 52.3″ at 224 GHz (CASA, from Brogan 2007)"},
    {"ATA", 6, {6, 0.5}, "6 m with a blockage of 0.5 m (CASA)"},
};

/// Beginnings of the names of telescopes whose antennas have no such beam.
struct Beamless {
  const char* telescope;
  const char* reason;
};

constexpr char stations[] = "its stations are arrays of dipoles, whose beams change with direction, time and frequency";
constexpr char zenith[] = "its antennas look at the zenith and do not track";
constexpr char cylinders[] = "its antennas are cylinders";

constexpr Beamless beamless[] = {
    {"LOFAR", stations},   {"AARTFAAC", stations}, {"NENUFAR", stations},  {"MWA", stations},     {"LWA", stations},
    {"OVROLWA", stations}, {"OVROMMA", stations},  {"SKALOW", stations},   {"SKA1LOW", stations}, {"AAVS", stations},
    {"EDA", stations},     {"21CMA", stations},    {"UTR2", stations},     {"GURT", stations},    {"PAPER", zenith},
    {"HERA", zenith},      {"CHIME", cylinders},   {"TIANLAI", cylinders}, {"MOST", cylinders},   {"UTMOST", cylinders},
};

std::string bare(const std::string& name) {
  std::string bare;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      bare += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return bare;
}

std::string in_metres(double length_m) {
  std::ostringstream text;
  text << length_m << " m";
  return text.str();
}

/// The sort that has this diameter, or the only one where none is given; else null.
const KnownDish* find_dish(const std::string& telescope, double diameter_m) {
  constexpr double alike_m = 0.5;
  const KnownDish* only = nullptr;
  int sorts = 0;
  for (const KnownDish& known : known_dishes) {
    if (telescope != known.telescope) continue;
    if (std::abs(diameter_m - known.diameter_m) <= alike_m) return &known;
    only = &known;
    ++sorts;
  }
  return !(diameter_m > 0) && sorts == 1 ? only : nullptr;
}

}  // namespace

DishModel dish_model(const AntennaSort& antennas) {
  const std::string telescope = bare(antennas.telescope);
  const std::string named = antennas.telescope.empty() ? "a telescope without a name" : antennas.telescope;
  for (const Beamless& one : beamless)
    if (telescope.rfind(one.telescope, 0) == 0) throw NoSimpleBeam(named + " has no simple primary beam: " + one.reason);
  if (const KnownDish* known = find_dish(telescope, antennas.diameter_m))
    return {known->dish, named + ": " + known->source, known->doubt};
  constexpr double smallest_m = 0.5, largest_m = 500;  // FAST's
  if (!(antennas.diameter_m >= smallest_m && antennas.diameter_m <= largest_m))
    throw NoSimpleBeam("no primary beam is known of " + named + ", and antenna '" + antennas.name +
                       "' has a DISH_DIAMETER of " + in_metres(antennas.diameter_m) + "; expected 0.5 m to 500 m");
  return {{antennas.diameter_m, 0},
          named + ": " + in_metres(antennas.diameter_m) + " from the column DISH_DIAMETER, uniformly lit",
          "the beam of " + named + "'s dishes of " + in_metres(antennas.diameter_m) +
              " is not known: it is taken to be that of a uniformly lit one, and is 5% to 20% wider where feeds light the edge "
              "less"};
}

}  // namespace misfit::imager
