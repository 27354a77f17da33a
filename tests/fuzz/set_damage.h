#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace misfit::fuzz {

/// Damages a MeasurementSet as bytes say, one thing after the other: tables and columns that are missing or of other types,
/// cells of other shapes, ids and numbers out of any range, rows too few, too many or in another order, other units, frames and
/// names, files that are cut or have other bytes. Damage that casacore refuses is left out. The same bytes do the same damage.
void damage(const std::string& set, const std::uint8_t* bytes, std::size_t count);

}  // namespace misfit::fuzz
