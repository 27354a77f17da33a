#include "tools/base/array.h"

#include <cmath>
#include <map>
#include <stdexcept>

namespace misfit::tools {
namespace {

using Vector = std::array<double, 3>;

constexpr double degree = M_PI / 180;
constexpr double earth_radius_m = 6371000;
constexpr double sidereal_rad_per_s = 2 * M_PI * 1.00273790935 / 86400;

/// The VLA's centre: geodetic latitude, longitude, ITRF position.
constexpr double vla_latitude_rad = 34.0787 * degree;
constexpr double vla_longitude_rad = -107.6184 * degree;
constexpr Vector vla_centre_m{-1601185.4, -5041977.5, 3554875.9};

struct Arm {
  char name;
  double azimuth_rad;  ///< from north through east
};
constexpr std::array<Arm, 3> vla_arms{{{'N', -5 * degree}, {'E', 115 * degree}, {'W', 236 * degree}}};
constexpr int stations_per_arm = 9;

Vector rotated_about_pole(const Vector& x, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]};
}

/// ITRF position of the place east, north and up of the VLA's centre.
Vector vla_itrf_m(const Vector& east_north_up_m) {
  const auto [east, north, up] = east_north_up_m;
  const double c = std::cos(vla_latitude_rad), s = std::sin(vla_latitude_rad);
  const Vector offset = rotated_about_pole({c * up - s * north, east, s * up + c * north}, vla_longitude_rad);
  return {vla_centre_m[0] + offset[0], vla_centre_m[1] + offset[1], vla_centre_m[2] + offset[2]};
}

AntennaArray vla(double arm_length_m) {
  AntennaArray array{"EVLA", {}, {}, 25, vla_latitude_rad};
  for (const Arm& arm : vla_arms)
    for (int i = 1; i <= stations_per_arm; ++i) {
      const double r = arm_length_m * std::pow(double(i) / stations_per_arm, 1.716);
      array.name.push_back(arm.name + std::to_string(i));
      // The ground falls away from the tangent plane at the centre by r²/2R.
      array.itrf_m.push_back(
          vla_itrf_m({r * std::sin(arm.azimuth_rad), r * std::cos(arm.azimuth_rad), -r * r / (2 * earth_radius_m)}));
    }
  return array;
}

double longitude_rad(const AntennaArray& array) {
  double x = 0, y = 0;
  for (const Vector& position : array.itrf_m) x += position[0], y += position[1];
  return std::atan2(y, x);
}

}  // namespace

AntennaArray antenna_array(const std::string& name) {
  constexpr double a_arm_m = 21000, step = 3.285;
  const std::map<std::string, double> arm_m{{"vla-a", a_arm_m},
                                            {"vla-b", a_arm_m / step},
                                            {"vla-c", a_arm_m / (step * step)},
                                            {"vla-d", a_arm_m / (step * step * step)}};
  const auto found = arm_m.find(name);
  if (found == arm_m.end())
    throw std::invalid_argument("array '" + name + "' is not known; expected vla-a, vla-b, vla-c or vla-d");
  return vla(found->second);
}

std::vector<double> uvw(const AntennaArray& array, const LocalDirection& source) {
  const double sh = std::sin(source.hour_angle_rad), ch = std::cos(source.hour_angle_rad);
  const double sd = std::sin(source.dec_rad), cd = std::cos(source.dec_rad);
  const double longitude = longitude_rad(array);
  std::vector<double> result;
  for (std::size_t i = 0; i < array.itrf_m.size(); ++i)
    for (std::size_t j = i + 1; j < array.itrf_m.size(); ++j) {
      const Vector &p = array.itrf_m[i], &q = array.itrf_m[j];
      // x to the meridian on the equator, y to the east, z to the pole
      const auto [x, y, z] = rotated_about_pole({q[0] - p[0], q[1] - p[1], q[2] - p[2]}, -longitude);
      result.push_back(sh * x + ch * y);
      result.push_back(-sd * ch * x + sd * sh * y + cd * z);
      result.push_back(cd * ch * x - cd * sh * y + sd * z);
    }
  return result;
}

double greenwich_mean_sidereal_time_rad(double mjd_s) {
  const double days = mjd_s / 86400 - 51544.5, t = days / 36525;  // since 2000 January 1.5
  // One turn a day apart, for the digits.
  const double seconds = 67310.54841 + (8640184.812866 + (0.093104 - 6.2e-6 * t) * t) * t;
  const double turns = seconds / 86400 + std::fmod(days, 1.0);
  return 2 * M_PI * (turns - std::floor(turns));
}

double hour_angle_rad(const AntennaArray& array, const imager::SkyDirection& direction, double mjd_s) {
  const double angle = greenwich_mean_sidereal_time_rad(mjd_s) + longitude_rad(array) - direction.ra_rad;
  return std::remainder(angle, 2 * M_PI);
}

double parallactic_angle_rad(const AntennaArray& array, const LocalDirection& source) {
  const double latitude = array.latitude_rad, dec = source.dec_rad, hour = source.hour_angle_rad;
  return std::atan2(std::cos(latitude) * std::sin(hour),
                    std::sin(latitude) * std::cos(dec) - std::cos(latitude) * std::sin(dec) * std::cos(hour));
}

double transit_mjd_s(const AntennaArray& array, const imager::SkyDirection& direction, double mjd_s) {
  return mjd_s - hour_angle_rad(array, direction, mjd_s) / sidereal_rad_per_s;
}

}  // namespace misfit::tools
