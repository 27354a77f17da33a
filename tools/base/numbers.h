#pragma once

#include <functional>
#include <string>
#include <vector>

#include "imager/data/geometry.h"

namespace misfit::tools {

/// `value` rounded to `digits` significant digits, in plain notation from 1e-4 to 1e6 and as 1.2e-07 outside, with a true
/// minus sign and no trailing zeros.
std::string significant(double value, int digits);

/// `value` with as many digits as bring the same double back.
std::string all_digits(double value);

/// `value` as "3.2 × 10⁻⁷" in plain text with spaces that do not break, to so many significant digits; plain notation from 0.01
/// to 1000.
std::string power_of_ten(double value, int digits);

/// `value` as "3.2 × " and the power of ten as `power` writes it, given the exponent.
std::string power_of_ten(double value, int digits, const std::function<std::string(int exponent)>& power);

/// `count` with a thin space between groups of three digits.
std::string grouped(long long count);

/// Whole numbers in ascending order, each once, with runs of three and more shortened: "0 to 3, 5 and 8".
std::string in_runs(std::vector<int> numbers);

/// A duration with the units a reader wants: 35 ms, 4.21 s, 2 min 05 s, 3 h 07 min.
std::string duration(double seconds);

/// A unit in which a number of magnitude `value` is easy to read: `value / size` lies between 1 and 1000 where it can.
struct ScaledUnit {
  double size = 1;   ///< in base units
  std::string name;  ///< e.g. "mJy/beam"
};

/// `base` (a unit such as "Jy/beam") with an SI prefix between n and k.
ScaledUnit scaled_unit(double value, const std::string& base);

/// An angle's unit for something of size `angle_rad`: mas, arcsec, arcmin or deg; `size` is in radians.
ScaledUnit angle_unit(double angle_rad);

/// A unit in which a distance in wavelengths is easy to read: λ, kλ, Mλ or Gλ.
ScaledUnit uv_unit(double lambda);

/// `value` in its scaled_unit(), as "1.2 mJy/beam".
std::string with_prefix(double value, const std::string& base, int digits);

/// The angle in its angle_unit(), as "1.2 arcsec".
std::string angle_text(double angle_rad, int digits);

/// A frequency in GHz, MHz, kHz or Hz, as "1.42041 GHz".
std::string frequency_text(double hz, int digits);

/// A direction as "12h 30m 49.42s  +12° 23′ 28.0″".
std::string sexagesimal(const imager::SkyDirection& direction);

}  // namespace misfit::tools
