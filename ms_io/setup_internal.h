#pragma once

#include <string>
#include <vector>

#include "ms_io/parsed_selection_internal.h"
#include "ms_io/selection_internal.h"

namespace misfit::ms_io {

/// The setups of `set`, one for each row of DATA_DESCRIPTION.
class SetupTable {
 public:
  explicit SetupTable(const casacore::MeasurementSet& set, const std::string& path);

  /// The spectral window of a DATA_DESC_ID. Throws std::runtime_error when there is no such DATA_DESC_ID or window.
  int spectral_window(int data_description) const;

  /// REF_FREQUENCY of the spectral window of a DATA_DESC_ID. Throws what spectral_window() does, and where the frequency is not
  /// positive and finite.
  double reference_frequency_hz(int data_description) const;

  /// The setup, with the channels selected. Throws std::runtime_error when a frequency is not positive and finite.
  Setup setup(int data_description, const ParsedSelection& parsed) const;

 private:
  const casacore::MeasurementSet& set_;
  std::string path_;
  std::vector<int> window_;        ///< [DATA_DESC_ID]
  std::vector<int> polarisation_;  ///< [DATA_DESC_ID]
};

}  // namespace misfit::ms_io
