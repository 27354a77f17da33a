#pragma once

#include <casacore/casa/BasicSL/Complex.h>

#include <atomic>
#include <cstddef>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "imager/data/ranks.h"
#include "ms_io/selection_internal.h"
#include "ms_io/zeros.h"

namespace misfit::ms_io {

/// One row's data as stored, and its flags, of as many correlations and channels.
struct RowData {
  const casacore::Complex* data = nullptr;
  const bool* flag = nullptr;  ///< null: no sample is flagged
  std::size_t values = 0;
};

/// Which fields of which spectral windows of a selection hold data, learned from rows as they are read: in any order,
/// repeatedly, and some channels at a time.
class FilledData {
 public:
  explicit FilledData(const std::vector<Setup>& setups);

  /// True if more rows could tell more; where none could, they need not be looked at.
  bool in_doubt() const { return doubts_ > 0; }
  /// Learns from a row. A row of zeros alone, all flagged, tells nothing.
  void look_at(int data_description, int field, const RowData& row);
  /// The zeros in what any of `ranks` has looked at; they call this together.
  Zeros zeros(const imager::Ranks& ranks) const;

 private:
  enum State : int { unread, zero, filled };
  struct Part {
    SelectionPart part;
    std::size_t place = 0;  ///< in state_
  };

  std::map<std::pair<int, int>, Part> parts_;  ///< by DATA_DESC_ID and field
  std::unique_ptr<std::atomic<int>[]> state_;
  std::atomic<std::size_t> doubts_;  ///< parts that are not known to be filled
};

}  // namespace misfit::ms_io
