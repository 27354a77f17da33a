#include "ms_io/celestial_frames.h"

#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MeasConvert.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "imager/numerics/constants.h"
#include "ms_io/celestial_frame_internal.h"

namespace misfit::ms_io {
namespace {

using casacore::MDirection;

const std::array<std::pair<const char*, MDirection::Types>, 4> frames{{
    {"ICRS", MDirection::ICRS},
    {"FK5", MDirection::J2000},
    {"FK4", MDirection::B1950},
    {"GALACTIC", MDirection::GALACTIC},
}};

/// Frames that regions may be of, and images not.
const std::array<std::pair<const char*, MDirection::Types>, 3> further_frames{{
    {"B1950_VLA", MDirection::B1950_VLA},
    {"ECLIPTIC", MDirection::ECLIPTIC},
    {"SUPERGAL", MDirection::SUPERGAL},
}};

/// Galactic coordinates in J2000: the direction of their pole, and the longitude of the celestial pole. They were defined in
/// B1950 (Blaauw et al. 1960, MNRAS 121, 123), by a pole at 12h49m, +27.4° and the longitude 123° of the celestial pole. These
/// numbers are that definition turned to J2000 without the terms of aberration (Murray 1989, A&A 218, 325), as in astropy, and
/// to 2 mas in SLALIB, DS9 and CARTA. casacore leaves the terms in, and lies 0.5 arcsec away; the Hipparcos Catalogue, and SOFA
/// after it, takes the first digits for ICRS, 0.025 arcsec away.
constexpr double rad_per_deg = imager::pi / 180;
constexpr double pole_ra_rad = 192.8594812065348 * rad_per_deg, pole_dec_rad = 27.12825118085622 * rad_per_deg,
                 pole_longitude_rad = 122.9319185680026 * rad_per_deg;

/// Longitude and latitude about one pole, turned to longitude and latitude about the other.
std::pair<double, double> about_other_pole(double longitude_rad, double latitude_rad) {
  const double x = std::cos(latitude_rad) * std::cos(longitude_rad), y = std::cos(latitude_rad) * std::sin(longitude_rad);
  const double z = std::sin(latitude_rad), c = std::cos(pole_dec_rad), s = std::sin(pole_dec_rad);
  const double other_x = c * z - s * x;
  return {std::atan2(y, other_x), std::atan2(s * z + c * x, std::hypot(other_x, y))};
}

double below_a_turn(double angle_rad) {
  const double turn = 2 * imager::pi, rest = std::fmod(angle_rad, turn);
  return rest < 0 ? rest + turn : rest;
}

imager::SkyDirection galactic_of(const imager::SkyDirection& j2000) {
  const auto [longitude, latitude] = about_other_pole(j2000.ra_rad - pole_ra_rad, j2000.dec_rad);
  return {below_a_turn(pole_longitude_rad - longitude), latitude, "GALACTIC"};
}

imager::SkyDirection j2000_of(const imager::SkyDirection& galactic) {
  const auto [longitude, latitude] = about_other_pole(pole_longitude_rad - galactic.ra_rad, galactic.dec_rad);
  return {below_a_turn(pole_ra_rad + longitude), latitude, "FK5"};
}

bool is_galactic(const std::string& frame) {
  return frame == "GALACTIC" || frame == "SUPERGAL";
}

MDirection::Types any_direction_type(const std::string& frame) {
  for (const auto& [name, type] : further_frames)
    if (name == frame) return type;
  return direction_type(frame);
}

}  // namespace

MDirection::Types direction_type(const std::string& frame) {
  for (const auto& [name, type] : frames)
    if (name == frame) return type;
  throw std::invalid_argument("celestial frame '" + frame + "', expected ICRS, FK5, FK4 or GALACTIC");
}

std::string frame_name(MDirection::Types type) {
  for (const auto& [name, code] : frames)
    if (code == type) return name;
  return "";
}

std::string still_frame_name(MDirection::Types type) {
  for (const auto& [name, code] :
       {std::pair("GALACTIC", MDirection::GALACTIC), {"SUPERGAL", MDirection::SUPERGAL}, {"ECLIPTIC", MDirection::ECLIPTIC}})
    if (code == type) return name;
  return "";
}

imager::SkyDirection sky_direction(const MDirection& direction) {
  const casacore::MVDirection& towards = direction.getValue();
  imager::SkyDirection sky;
  sky.ra_rad = towards.getLong() < 0 ? towards.getLong() + 2 * imager::pi : towards.getLong();
  sky.dec_rad = std::atan2(towards(2), std::hypot(towards(0), towards(1)));  // getLat() is not exact beside the poles
  sky.frame = frame_name(MDirection::castType(direction.getRef().getType()));
  return sky;
}

MDirection measure_of(const imager::SkyDirection& direction) {
  return {casacore::MVDirection(direction.ra_rad, direction.dec_rad), direction_type(direction.frame)};
}

imager::SkyDirection in_frame(const imager::SkyDirection& direction, const std::string& frame) {
  const std::string& from = direction.frame;
  if (from == frame) return direction;
  if (!(is_galactic(from) && is_galactic(frame))) {  // between which lies a turn, of one sphere
    if (from == "SUPERGAL" || frame == "SUPERGAL") return in_frame(in_frame(direction, "GALACTIC"), frame);
    if (from == "GALACTIC") return in_frame(j2000_of(direction), frame);
    if (frame == "GALACTIC") return galactic_of(in_frame(direction, "FK5"));
  }
  const MDirection here(casacore::MVDirection(direction.ra_rad, direction.dec_rad), any_direction_type(direction.frame));
  imager::SkyDirection there = sky_direction(MDirection::Convert(here, MDirection::Ref(any_direction_type(frame)))());
  there.frame = frame;
  return there;
}

}  // namespace misfit::ms_io
