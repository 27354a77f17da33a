#pragma once

#include <string>

namespace misfit::tools {

/// Numbers with units as astronomers write them: "0.2arcsec", "-40deg", "1.2 mas", "10mJy", "4GHz". A number alone is in the
/// unit that each function names. Throw std::invalid_argument that shows the text and what was expected.
double parse_angle_rad(const std::string& text);           ///< deg, amin, asec, mas, uas, rad, …; alone: arcsec, as in tclean
double parse_flux_jy(const std::string& text);             ///< Jy, mJy, uJy; alone: Jy
double parse_frequency_hz(const std::string& text);        ///< Hz, kHz, MHz, GHz; alone: Hz
double parse_velocity_m_s(const std::string& text);        ///< m/s, km/s; none alone
double parse_uv_distance_lambda(const std::string& text);  ///< lambda, klambda, Mlambda; alone: wavelengths

/// True if such a quantity ends in a unit.
bool has_unit(const std::string& text);

}  // namespace misfit::tools
