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

/// Whether casacore has a table of planets, which it then keeps.
bool has_tables(MeasJPL::Files file) {
  double any = 0;
  try {
    return MeasJPL::getConst(any, file, MeasJPL::AU);
  } catch (const casacore::AipsError&) {
    return false;
  }
}

/// AU from the middle of the solar system.
std::array<double, 3> position_au(MeasJPL::Files file, MeasJPL::Types body, double tdb_mjd) {
  casacore::Vector<double> values(6);
  if (!has_tables(file) || !MeasJPL::get(values, file, body, casacore::MVEpoch(tdb_mjd)))
    throw casacore::AipsError(
        "casacore takes the place of planets from the tables DE200 or DE405, which are not in the folder of its data, nor in " +
        std::string(packaged_data) +
        ", or do not reach that time; expected these tables there, as the packages casacore-data-jpl-de200 and -de405 bring "
        "them, or the table of an ephemeris");
  return {values(0), values(1), values(2)};
}

}  // namespace

std::optional<MDirection::Types> planet_named(const std::string& name) {
  const std::string known = capitals(name);
  for (const KnownPlanet& one : planets)
    if (known == one.name) return one.code;
  return {};
}

PlanetPlace planet_place(MDirection::Types planet, double tdb_mjd) {
  find_planet_tables();
  const auto* const known =
      std::find_if(planets.begin(), planets.end(), [&](const KnownPlanet& one) { return one.code == planet; });
  if (known == planets.end()) throw casacore::AipsError("no planet has the code " + std::to_string(planet));
  const MeasJPL::Files file = has_tables(MeasJPL::DE405) ? MeasJPL::DE405 : MeasJPL::DE200;
  const std::array<double, 3> earth = position_au(file, MeasJPL::EARTH, tdb_mjd);
  double au_km = 0;
  MeasJPL::getConst(au_km, file, MeasJPL::AU);
  const double au_m = 1e3 * au_km;
  std::array<double, 3> away{};
  double distance_m = 0, before_m = -1;
  while (std::abs(distance_m - before_m) > 1e-3) {  // each step is 1e-4, the planet's speed over light's, of that before
    before_m = distance_m;
    constexpr double day_s = 86400;
    const std::array<double, 3> then =
        position_au(file, known->in_tables, tdb_mjd - distance_m / imager::speed_of_light_m_s / day_s);
    for (std::size_t i = 0; i < 3; ++i) away[i] = then[i] - earth[i];
    distance_m = au_m * std::hypot(away[0], away[1], away[2]);
  }
  casacore::MVDirection direction(away[0], away[1], away[2]);
  direction.adjust();
  return {{direction, file == MeasJPL::DE405 ? MDirection::ICRS : MDirection::J2000}, distance_m};
}

void find_planet_tables() {
  static std::once_flag once;
  std::call_once(once, [] {
    const bool both = has_tables(MeasJPL::DE405) && has_tables(MeasJPL::DE200);
    if (both) return;
    casacore::AppStateSource::initialize(new PackagedData);  // which casacore owns from here on
    has_tables(MeasJPL::DE405);
    has_tables(MeasJPL::DE200);
    casacore::AppStateSource::initialize(new casacore::AppState);
  });
}

}  // namespace misfit::ms_io
