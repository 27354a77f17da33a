#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ms_io/selection_internal.h"

namespace misfit::ms_io {

/// Rows of a group, one after another there, that are of one block.
struct Share {
  std::size_t block = 0;  ///< of the group
  std::uint64_t rows = 0;
};

/// Blocks that follow one another and are read at once, because rows of DATA_DESC_IDs whose cells are alike alternate: together
/// they are ranges of the table, which are read faster than row by row. Else one block.
struct BlockGroup {
  std::size_t blocks = 0;
  std::vector<Run> runs;      ///< rows of all the blocks, ascending
  std::vector<Share> shares;  ///< of the same rows
};

/// The group that begins with the block `first`. It has no more samples than 2²³, unless that block does.
BlockGroup block_group(const SelectedRows& selected, std::size_t first);

}  // namespace misfit::ms_io
