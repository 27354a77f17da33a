#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {

using OpenSets = std::vector<std::shared_ptr<const OpenSet>>;

/// The rows of a block from `first` up to `end`.
BlockRows rows_between(const BlockRows& block, std::uint64_t first, std::uint64_t end);

/// Where the selected rows of one or several sets are cut into parts of about equally many samples. A part is a range of rows
/// of the main tables, which is a range of times as far as rows are in the order of time; a cut within a fiftieth of a part's
/// samples from the border between two sets lies there.
class RowShares {
 public:
  RowShares(const OpenSets& sets, int parts);

  /// The sets with the rows of one part, without those sets that have none of them.
  OpenSets part(int index) const;
  /// [part]
  const std::vector<std::uint64_t>& samples() const { return samples_; }
  /// True if every set is whole in some part.
  bool whole_sets() const { return whole_sets_; }

 private:
  /// A cut before a row of a set.
  struct Cut {
    std::size_t set = 0;
    std::uint64_t row = 0;
  };

  Cut cut_at(std::uint64_t samples, std::uint64_t tolerance) const;

  const OpenSets& sets_;
  std::vector<Cut> cuts_;  ///< [part], its beginning; and the end of the last
  std::vector<std::uint64_t> samples_;
  bool whole_sets_ = true;
};

}  // namespace misfit::ms_io
