#include "ms_io/celestial_frames.h"

#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MeasConvert.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "imager/constants.h"
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
  if (direction.frame == frame) return direction;
  const MDirection here(casacore::MVDirection(direction.ra_rad, direction.dec_rad), any_direction_type(direction.frame));
  imager::SkyDirection there = sky_direction(MDirection::Convert(here, MDirection::Ref(any_direction_type(frame)))());
  there.frame = frame;
  return there;
}

}  // namespace misfit::ms_io
