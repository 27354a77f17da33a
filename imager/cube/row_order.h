#pragma once

#include <cstdint>
#include <vector>

namespace misfit::imager {

/// The rows of UVW [row][3] in an order in which neighbours lie near each other in the half plane v ≥ 0, where gridding has
/// them: along a space-filling curve (Hilbert 1891) over the square that holds all of them. Since neighbours stay neighbours
/// when u and v are scaled, one order serves planes of all frequencies. Rows of one place follow each other as given; rows
/// whose u or v is not finite come first.
std::vector<std::uint32_t> order_in_uv(const std::vector<double>& uvw_m);

}  // namespace misfit::imager
