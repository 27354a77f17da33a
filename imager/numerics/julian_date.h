#pragma once

#include <optional>
#include <string>

namespace misfit::imager {

/// The modified Julian date of an ISO 8601 date such as 2026-01-31 or 2026-01-31T12:00:00.5, in days of the same time scale;
/// nothing where the text is none. (Proleptic Gregorian calendar; day 0 is 1858-11-17.)
std::optional<double> modified_julian_date(const std::string& iso);

}  // namespace misfit::imager
