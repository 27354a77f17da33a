#include <casacore/casa/Quanta/MVEpoch.h>
#include <casacore/casa/System/AppState.h>
#include <casacore/measures/Measures/MeasJPL.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <list>
#include <mutex>
#include <utility>

#include "imager/numerics/constants.h"
#include "ms_io/capitals.h"
#include "ms_io/planets_internal.h"

namespace misfit::ms_io {
namespace {

using casacore::MDirection;
using casacore::MeasJPL;

struct KnownPlanet {
  const char* name;
  MDirection::Types code;
  MeasJPL::Types in_tables;
};

constexpr std::array<KnownPlanet, 10> planets{{{"MERCURY", MDirection::MERCURY, MeasJPL::MERCURY},
                                               {"VENUS", MDirection::VENUS, MeasJPL::VENUS},
                                               {"MARS", MDirection::MARS, MeasJPL::MARS},
                                               {"JUPITER", MDirection::JUPITER, MeasJPL::JUPITER},
                                               {"SATURN", MDirection::SATURN, MeasJPL::SATURN},
                                               {"URANUS", MDirection::URANUS, MeasJPL::URANUS},
                                               {"NEPTUNE", MDirection::NEPTUNE, MeasJPL::NEPTUNE},
                                               {"PLUTO", MDirection::PLUTO, MeasJPL::PLUTO},
                                               {"SUN", MDirection::SUN, MeasJPL::SUN},
                                               {"MOON", MDirection::MOON, MeasJPL::MOON}}};

constexpr const char* packaged_data = "/usr/share/casacore/data";

/// Data of casacore are looked for where Debian's packages put them, alone.
class PackagedData : public casacore::AppState {
 public:
  std::list<std::string> dataPath() const override { return {packaged_data}; }
  bool initialized() const override { return true; }
};

/// True if casacore has a table of planets, which it then keeps.
bool has_table(MeasJPL::Files file) {
  double any = 0;
  try {
    return MeasJPL::getConst(any, file, MeasJPL::AU);
  } catch (const casacore::AipsError&) {
    return false;
  }
}

/// DE405, or DE200 where there is no other; nothing without both.
std::optional<MeasJPL::Files> best_table() {
  static const std::optional<MeasJPL::Files> best = []() -> std::optional<MeasJPL::Files> {
    find_planet_tables();
    if (has_table(MeasJPL::DE405)) return MeasJPL::DE405;
    if (has_table(MeasJPL::DE200)) return MeasJPL::DE200;
    return std::nullopt;
  }();
  return best;
}

[[noreturn]] void refuse_without_tables() {
  throw casacore::AipsError(
      "casacore takes the place of planets from the tables DE200 or DE405, which are not in the folder of its data, nor in " +
      std::string(packaged_data) +
      ", or do not reach that time; expected these tables there, as the packages casacore-data-jpl-de200 and -de405 bring "
      "them, or the table of an ephemeris");
}

/// AU from the middle of the solar system, as the table has it.
std::array<double, 3> tabled_au(MeasJPL::Files file, MeasJPL::Types body, double tdb_mjd) {
  casacore::Vector<double> values(6);
  if (!MeasJPL::get(values, file, body, casacore::MVEpoch(tdb_mjd))) refuse_without_tables();
  return {values(0), values(1), values(2)};
}

/// AU from the middle of the solar system. The Moon's place follows from the Earth's and that of the centre of mass of both,
/// which lies 1/(1 + EMRAT) of the way to the Moon from the Earth: casacore 3.5 adds the whole way to the latter, 1/82 too far.
std::array<double, 3> position_au(MeasJPL::Files file, MeasJPL::Types body, double tdb_mjd) {
  if (body != MeasJPL::MOON) return tabled_au(file, body, tdb_mjd);
  double earth_over_moon = 0;
  MeasJPL::getConst(earth_over_moon, file, casacore::String("EMRAT"));
  const std::array<double, 3> earth = tabled_au(file, MeasJPL::EARTH, tdb_mjd);
  std::array<double, 3> moon = tabled_au(file, MeasJPL::BARYEARTH, tdb_mjd);
  for (std::size_t i = 0; i < 3; ++i) moon[i] = earth[i] + (1 + earth_over_moon) * (moon[i] - earth[i]);
  return moon;
}

}  // namespace

std::optional<MDirection::Types> planet_named(const std::string& name) {
  const std::string known = capitals(name);
  for (const KnownPlanet& one : planets)
    if (known == one.name) return one.code;
  return {};
}

PlanetPlace planet_place(MDirection::Types planet, double tdb_mjd) {
  const std::optional<MeasJPL::Files> file = best_table();
  if (!file) refuse_without_tables();
  const auto* const known =
      std::find_if(planets.begin(), planets.end(), [&](const KnownPlanet& one) { return one.code == planet; });
  if (known == planets.end()) throw casacore::AipsError("no planet has the code " + std::to_string(planet));
  const std::array<double, 3> earth = position_au(*file, MeasJPL::EARTH, tdb_mjd);
  double au_km = 0;
  MeasJPL::getConst(au_km, *file, MeasJPL::AU);
  std::array<double, 3> away{};
  double distance_m = 0;
  // Each step leaves of the distance's error 1e-4, the planet's speed over light's, of 1e13 m at first; times are stored to
  // 1e-6 s, in which a planet goes some centimetres.
  constexpr int steps = 5;
  for (int step = 0; step < steps; ++step) {
    constexpr double day_s = 86400;
    const std::array<double, 3> then =
        position_au(*file, known->in_tables, tdb_mjd - distance_m / imager::speed_of_light_m_s / day_s);
    for (std::size_t i = 0; i < 3; ++i) away[i] = then[i] - earth[i];
    distance_m = 1e3 * au_km * std::hypot(away[0], away[1], away[2]);
  }
  casacore::MVDirection direction(away[0], away[1], away[2]);
  direction.adjust();
  return {{direction, *file == MeasJPL::DE405 ? MDirection::ICRS : MDirection::J2000}, distance_m};
}

void find_planet_tables() {
  static std::once_flag once;
  std::call_once(once, [] {
    const bool both = has_table(MeasJPL::DE405) && has_table(MeasJPL::DE200);
    if (both || casacore::AppStateSource::fetch().initialized()) return;  // whose folders somebody else has set
    casacore::AppStateSource::initialize(new PackagedData);               // which casacore owns from here on
    has_table(MeasJPL::DE405);
    has_table(MeasJPL::DE200);
    casacore::AppStateSource::initialize(new casacore::AppState);
  });
}

}  // namespace misfit::ms_io
