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

/// The rows and channels of a selection.
struct ParsedSelection {
  bool all_fields = true;
  std::set<int> fields;
  bool all_windows = true;
  std::map<int, std::set<int>> channels;  ///< of each spectral window selected
  std::vector<int> listed_windows;        ///< the selected windows, as the expression lists them; empty: all
  std::vector<UvRange> uv;                ///< one of them must hold, unless there are none
  casacore::TableExprNode rows;           ///< true where the rest of the selection holds; null: everywhere
  std::vector<bool> listed_rows;          ///< [row] stands for `rows`, unless it is empty

  bool has_field(int field) const { return all_fields || fields.count(field) > 0; }
  bool has_window(int window) const { return all_windows || channels.count(window) > 0; }
  /// The place of a window among the listed ones; its id where none are listed.
  std::size_t place_of(int window) const;
  bool uv_in_wavelengths() const;  ///< whether any range is
  /// True if one of `uv` holds, or there are none; in wavelengths, of the reference frequency. It is a function of its own
  /// since TaQL takes 6 µs for a row.
  bool has_uv(const double* uvw_m, double reference_frequency_hz) const;
  /// True if `rows` or `listed_rows` hold for a row of the table as it was opened, whatever table the row is stored in. Throws
  /// AipsError where they cannot be read.
  bool has_row(std::uint64_t row) const;
};

/// Parses `selection` with casacore's MSSelection. Throws std::runtime_error that names the expression at fault and what it may
/// be. A channel beyond the end of its window is one; a range of channels that goes beyond it ends there.
ParsedSelection parse_selection(const casacore::MeasurementSet& set, const std::string& path, const Selection& selection);

}  // namespace misfit::ms_io
