#include "imager/numerics/julian_date.h"

#include <cstdio>

namespace misfit::imager {
namespace {

/// Days since 1858-11-17. Years are counted from March, so that the day that leap years add is their last.
long days(long year, long month, long day) {
  const long from_march = month > 2 ? month - 3 : month + 9;
  const long y = month > 2 ? year : year - 1;
  return 365 * y + y / 4 - y / 100 + y / 400 + (153 * from_march + 2) / 5 + day - 678882;
}

}  // namespace

std::optional<double> modified_julian_date(const std::string& iso) {
  int year = 0, month = 0, day = 0, hours = 0, minutes = 0;
  double seconds = 0;
  const int read = std::sscanf(iso.c_str(), "%4d-%2d-%2dT%2d:%2d:%lf", &year, &month, &day, &hours, &minutes, &seconds);
  if ((read != 3 && read != 6) || year < 0 || month < 1 || month > 12 || day < 1 || day > 31) return std::nullopt;
  return static_cast<double>(days(year, month, day)) + (hours + (minutes + seconds / 60) / 60) / 24.0;
}

}  // namespace misfit::imager
