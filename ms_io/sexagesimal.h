#pragma once

#include <optional>
#include <string_view>

namespace misfit::ms_io {

/// Angles in sexagesimal parts, as directions are written: hours, as in 12h30m49.4s and 12:30:49.4, or degrees, as in
/// +12d23m28s, +12:23:28.0 and +12.23.28.0.

/// True if `text` begins like a sexagesimal angle, so that it is nothing else: with digits, and behind them an h, a colon, a d
/// that begins neither "deg" nor the end, or two dots.
bool is_sexagesimal(std::string_view text);

/// The unit of the first part where colons separate the parts.
enum class Colons { hours, degrees };

/// Which parts must be written: all, with an s after the seconds where letters separate parts; or, as CASA's tasks allow,
/// perhaps no seconds after letters and colons, or no s.
enum class Parts { all, some };

/// ±(units + (60 minutes + seconds) / 3600), rad. Seconds may be 60, since programs that round them write that; minutes are
/// below 60, units at most 24 hours or 360 degrees. Nothing where `text` is no such angle.
std::optional<double> sexagesimal_rad(std::string_view text, Colons colons, Parts parts = Parts::all);

}  // namespace misfit::ms_io
