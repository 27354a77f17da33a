#pragma once

namespace misfit::imager {

inline constexpr double speed_of_light_m_s = 299792458.0;
inline constexpr double pi = 3.14159265358979323846;

}  // namespace misfit::imager
