#include "imager/beams/telescopes.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "imager/beams/airy_pattern.h"
#include "imager/beams/polynomial_pattern.h"
#include "imager/beams/tapered_pattern.h"

namespace misfit::imager {
namespace {

/// A sort of dishes of a telescope.
struct KnownBeam {
  const char* telescope;
  double diameter_m;  ///< of the reflector, by which a telescope's sorts are told apart
  Pattern pattern;
  const char* source;
  const char* doubt = "";
};

constexpr char vla[] = "fits to its measured beams, by frequency (Perley 2016, EVLA Memo 195)";
constexpr char alma_12_m[] = "12 m dishes, Airy disc of 10.7 m with a blockage of 0.75 m (CASA, from Hunter & Brogan 2011)";
constexpr char alma_7_m[] = "7 m dishes, Airy disc of 6.25 m with a blockage of 0.75 m (CASA, from Hunter & Brogan 2011)";
constexpr char askap[] = "Gaussian, 1.09 λ/12 m wide (Hotan et al. 2021, PASA 38, e009)";
constexpr char gmrt[] = "fits to its bands 2 to 5 (NCRA 2022, updated primary-beam shape parameters)";
constexpr char noema[] = "Airy disc of 15 m with a blockage of 1 m (CASA)";
constexpr char formed_beams[] =
    "ASKAP's beams are formed from phased-array feeds, and only roughly Gaussians: where measured ones are at hand, they are "
    "the "
    "ones to correct by";

/// The known beams, one object for each: pairs of dishes with the same pattern objects are alike.
const std::vector<KnownBeam>& known_beams() {
  static const std::vector<KnownBeam> beams = [] {
    const Pattern of_vla = polynomial_pattern(vla_beams()), of_12_m = airy_pattern({10.7, 0.75}),
                  of_7_m = airy_pattern({6.25, 0.75}), of_askap = gaussian_pattern(1.09, 12), of_noema = airy_pattern({15, 1}),
                  of_gmrt = polynomial_pattern(gmrt_beams());
    return std::vector<KnownBeam>{
        {"VLA", 25, of_vla, vla},
        {"EVLA", 25, of_vla, vla},
        {"JVLA", 25, of_vla, vla},
        {"ALMA", 12, of_12_m, alma_12_m},
        {"ALMA", 7, of_7_m, alma_7_m},
        {"ACA", 7, of_7_m, alma_7_m},
        {"ACA", 12, of_12_m, alma_12_m},
        {"GMRT", 45, of_gmrt, gmrt},
        {"UGMRT", 45, of_gmrt, gmrt},
        {"ATCA", 22, polynomial_pattern(atca_beams()),
         "fits to its bands (Wieringa & Kesteven 1992, and later ones, as CASA has them)"},
        {"WSRT", 25, cosine_cubed_pattern(0.0629, 0.065, 800e6),
         "cos⁶ of the angle times the frequency (NEWSTAR, as CASA has it)"},
        {"ASKAP", 12, of_askap, askap, formed_beams},
        {"ASKAP36", 12, of_askap, askap, formed_beams},
        {"MEERKAT", 13.5, cosine_tapered_pattern(57.5 * 1.5),
         "cosine-tapered field, 57.5′ wide at 1.5 GHz (Mauch et al. 2020, ApJ 888, 61)"},
        {"NGVLA", 18, airy_pattern({18, 0}), "Airy disc of 18 m (CASA)"},
        {"NOEMA", 15, of_noema, noema},
        {"IRAMPDB", 15, of_noema, noema},
        {"SMA", 6, airy_pattern({5.43, 0}), "6 m, Airy disc of 5.43 m: 52.3″ at 224 GHz (CASA, from Brogan 2007)"},
        {"ATA", 6, airy_pattern({6, 0.5}), "Airy disc of 6 m with a blockage of 0.5 m (CASA)"},
    };
  }();
  return beams;
}

/// Beginnings of the names of telescopes whose antennas have no simple beam.
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
const KnownBeam* find_beam(const std::string& telescope, double diameter_m) {
  constexpr double alike_m = 0.5;
  const KnownBeam* only = nullptr;
  int sorts = 0;
  for (const KnownBeam& known : known_beams()) {
    if (telescope != known.telescope) continue;
    if (std::abs(diameter_m - known.diameter_m) <= alike_m) return &known;
    only = &known;
    ++sorts;
  }
  return !(diameter_m > 0) && sorts == 1 ? only : nullptr;
}

std::string name_of(const AntennaSort& antennas) {
  return antennas.telescope.empty() ? "a telescope without a name" : antennas.telescope;
}

double own_diameter_m(const AntennaSort& antennas) {
  constexpr double smallest_m = 0.5, largest_m = 500;  // FAST's
  if (!(antennas.diameter_m >= smallest_m && antennas.diameter_m <= largest_m))
    throw NoSimpleBeam("no primary beam is known of " + name_of(antennas) + ", and antenna '" + antennas.name +
                       "' has a DISH_DIAMETER of " + in_metres(antennas.diameter_m) + "; expected 0.5 m to 500 m");
  return antennas.diameter_m;
}

/// The dish of "airy:D" or "airy:D:B"; nothing where the name is no such.
std::optional<Dish> named_dish(const std::string& name) {
  constexpr char before[] = "airy:";
  if (name.rfind(before, 0) != 0) return std::nullopt;
  std::istringstream text(name.substr(sizeof before - 1));
  Dish dish;
  char colon = 0;
  text >> dish.diameter_m;
  if (!text.eof()) text >> colon >> dish.blockage_m;
  const bool is_read = !text.fail() && text.eof() && (colon == 0 || colon == ':');
  return is_read && dish.blockage_m >= 0 && dish.blockage_m < dish.diameter_m ? std::optional(dish) : std::nullopt;
}

/// The sort of a telescope that has this diameter, or its first; null where it is not known, or the name may be a file's.
const KnownBeam* named_sort(const std::string& name, double diameter_m) {
  if (name.find_first_of("./") != std::string::npos) return nullptr;
  const std::string telescope = bare(name);
  if (const KnownBeam* alike = find_beam(telescope, diameter_m)) return alike;
  const auto& beams = known_beams();
  const auto first =
      std::find_if(beams.begin(), beams.end(), [&](const KnownBeam& known) { return telescope == known.telescope; });
  return first == beams.end() ? nullptr : &*first;
}

}  // namespace

BeamModel beam_model(const AntennaSort& antennas) {
  const std::string telescope = bare(antennas.telescope), named = name_of(antennas);
  for (const Beamless& one : beamless)
    if (telescope.rfind(one.telescope, 0) == 0)
      throw NoSimpleBeam(named + " has no simple primary beam: " + one.reason + "; --beam gives one");
  if (const KnownBeam* known = find_beam(telescope, antennas.diameter_m))
    return {known->pattern, named + ": " + known->source, known->doubt};
  const double own_m = own_diameter_m(antennas);
  return {airy_pattern({own_m, 0}), named + ": " + in_metres(own_m) + " from the column DISH_DIAMETER, uniformly lit",
          "the beam of " + named + "'s dishes of " + in_metres(own_m) +
              " is not known: it is taken to be that of a uniformly lit one, and is 5% to 20% wider where feeds light the edge "
              "less"};
}

BeamModel named_beam(const std::string& name, const AntennaSort& antennas) {
  const std::string asked = "--beam " + name + ": ";
  if (const KnownBeam* known = named_sort(name, antennas.diameter_m))
    return {known->pattern, asked + known->source, known->doubt};
  if (name == "airy") {
    const double own_m = own_diameter_m(antennas);
    return {airy_pattern({own_m, 0}), asked + in_metres(own_m) + " from the column DISH_DIAMETER, uniformly lit"};
  }
  const std::optional<Dish> dish = named_dish(name);
  if (!dish) throw std::invalid_argument("beam '" + name + "'; expected " + expected_beam_names());
  return {airy_pattern(*dish), asked + "Airy disc"};
}

bool is_beam_name(const std::string& name) {
  return name == "airy" || named_dish(name) || named_sort(name, 0) != nullptr;
}

std::string expected_beam_names() {
  std::string names, before;
  for (const KnownBeam& known : known_beams()) {
    if (before != known.telescope) names += std::string(known.telescope) + ", ";
    before = known.telescope;
  }
  return names + "airy, or airy:D or airy:D:B, a diameter and a blockage in metres";
}

}  // namespace misfit::imager
