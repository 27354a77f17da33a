#pragma once

#include <map>
#include <set>
#include <string>

#include "ms_io/selection_internal.h"

namespace misfit::ms_io {

/// What a selection says about rows and channels, whatever the rows are.
struct ParsedSelection {
  bool all_fields = true;
  std::set<int> fields;
  bool all_windows = true;
  std::map<int, std::set<int>> channels;  ///< of each spectral window selected

  bool has_field(int field) const { return all_fields || fields.count(field) > 0; }
  bool has_window(int window) const { return all_windows || channels.count(window) > 0; }
};

/// Parses `selection` with casacore's MSSelection. Throws std::runtime_error that names the expression.
ParsedSelection parse_selection(const casacore::MeasurementSet& set, const std::string& path, const Selection& selection);

/// The setups of `set`, one for each row of DATA_DESCRIPTION.
class SetupTable {
 public:
  explicit SetupTable(const casacore::MeasurementSet& set, const std::string& path);

  /// The spectral window of a DATA_DESC_ID. Throws std::runtime_error when there is no such DATA_DESC_ID or window.
  int spectral_window(int data_description) const;

  /// The setup, with the channels selected. Throws std::runtime_error when a frequency is not positive and finite.
  Setup setup(int data_description, const ParsedSelection& parsed) const;

 private:
  const casacore::MeasurementSet& set_;
  std::string path_;
  std::vector<int> window_;        ///< [DATA_DESC_ID]
  std::vector<int> polarisation_;  ///< [DATA_DESC_ID]
};

}  // namespace misfit::ms_io
