#pragma once

#include <casacore/ms/MeasurementSets/MeasurementSet.h>
#include <casacore/tables/TaQL/ExprNode.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "ms_io/selection.h"

namespace misfit::ms_io {

/// A range of √(u² + v²), its ends within.
struct UvRange {
  double least = 0;
  double most = 0;
  bool in_metres = true;  ///< else in wavelengths
};

/// What a selection says about rows and channels.
struct ParsedSelection {
  bool all_fields = true;
  std::set<int> fields;
  bool all_windows = true;
  std::map<int, std::set<int>> channels;  ///< of each spectral window selected
  std::vector<int> listed_windows;        ///< those selected, as the expression lists them; empty: all
  std::vector<UvRange> uv;                ///< one of them must hold, unless there are none
  casacore::TableExprNode rows;           ///< true where the rest of the selection holds; null: everywhere
  std::vector<bool> listed_rows;          ///< [row] the same in place of `rows`; empty where that tells

  bool has_field(int field) const { return all_fields || fields.count(field) > 0; }
  bool has_window(int window) const { return all_windows || channels.count(window) > 0; }
  /// Where a window stands among those that are listed; its id where none are.
  std::size_t place_of(int window) const;
  bool uv_in_wavelengths() const;  ///< whether some of it is
  /// Whether one of `uv` holds, or there are none; in wavelengths, of the reference frequency. TaQL takes 6 µs for a row, which
  /// is why this is apart.
  bool has_uv(const double* uvw_m, double reference_frequency_hz) const;
  /// Of the table as it was opened, whatever table its rows are stored in. Throws AipsError where they cannot be read.
  bool has_row(std::uint64_t row) const;
};

/// Parses `selection` with casacore's MSSelection. Throws std::runtime_error that names the expression at fault and what it may
/// be. A channel beyond the end of its window is one; a range of channels that goes beyond it ends there.
ParsedSelection parse_selection(const casacore::MeasurementSet& set, const std::string& path, const Selection& selection);

}  // namespace misfit::ms_io
