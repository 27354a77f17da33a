#pragma once

#include <array>
#include <string>
#include <vector>

#include "imager/data/geometry.h"

namespace misfit::tools {

struct AntennaArray {
  std::string telescope;
  std::vector<std::string> name;
  std::vector<std::array<double, 3>> itrf_m;
  double dish_diameter_m = 0;
  double latitude_rad = 0;  ///< geodetic
};

/// A direction as the array sees it: local hour angle at the longitude of the array's mean position, and declination.
struct LocalDirection {
  double hour_angle_rad = 0;
  double dec_rad = 0;
};

/// The array called `name`: vla-a, vla-b, vla-c or vla-d, 27 antennas on three arms at distances ∝ (i/9)^1.716 (Thompson,
/// Clark, Wade & Napier 1980, ApJS 44, 151). Throws std::invalid_argument that lists the names.
AntennaArray antenna_array(const std::string& name);

/// UVW in metres [baseline][3] over antenna1 < antenna2, antenna2 fastest: position of antenna 2 − position of antenna 1 along
/// u to the east, v to the north and w towards the source (Thompson, Moran & Swenson 2017, Interferometry and Synthesis in
/// Radio Astronomy).
std::vector<double> uvw(const AntennaArray& array, const LocalDirection& source);

/// Greenwich mean sidereal time in [0, 2π), IAU 1982 (Aoki et al. 1982, A&A 105, 359), of a time in MJD seconds. UT1 is taken
/// to be UTC, less than 0.9 s away.
double greenwich_mean_sidereal_time_rad(double mjd_s);

/// Local hour angle in [−π, π]. The direction is taken to be of date: J2000 positions are 0.014° a year off since 2000, so
/// simulate near then when UVW should be those of the real sky.
double hour_angle_rad(const AntennaArray& array, const imager::SkyDirection& direction, double mjd_s);

/// The position angle of the zenith, from north through east, as seen from a direction: the parallactic angle.
double parallactic_angle_rad(const AntennaArray& array, const LocalDirection& source);

/// The transit of `direction` nearest to `mjd_s`.
double transit_mjd_s(const AntennaArray& array, const imager::SkyDirection& direction, double mjd_s);

}  // namespace misfit::tools
