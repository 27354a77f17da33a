#pragma once

#include <casacore/measures/Measures/MDirection.h>

#include <optional>
#include <string>

namespace misfit::ms_io {

/// casacore's code of a body of the solar system by its whole name, such as "JUPITER", in capitals or not; nothing where the
/// tables of JPL have none of that name.
std::optional<casacore::MDirection::Types> planet_named(const std::string& name);

/// Where a planet was when light left it that now comes to the middle of the Earth.
struct PlanetPlace {
  casacore::MDirection direction;  ///< from where the Earth is, without aberration: ICRS or, from DE200, J2000
  double distance_m = 0;
};

/// The place by DE405 (Standish 1998, JPL IOM 312.F-98-048), or by DE200 where casacore lacks DE405. Throws casacore::AipsError
/// where casacore has neither, or they do not reach that time.
PlanetPlace planet_place(casacore::MDirection::Types planet, double tdb_mjd);

/// Lets casacore find the tables of JPL in Debian's folder, where it does not look by itself.
void find_planet_tables();

}  // namespace misfit::ms_io
