#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ms_io/selection_internal.h"

namespace misfit::ms_io {

/// Blocks that follow one another and are read at once, because rows of DATA_DESC_IDs whose cells are alike alternate: together
/// they are ranges of the table, which are read faster than row by row. Otherwise a group is one block.
struct BlockGroup {
  std::size_t blocks = 0;
  std::uint64_t rows = 0;
  std::vector<Run> runs;             ///< rows of all the blocks, ascending
  std::vector<std::uint16_t> owner;  ///< [row of the group] which of its blocks; empty where there is one
};

/// The group that begins with the block `first`. It has no more samples than 2²³, unless that block does.
BlockGroup block_group(const SelectedRows& selected, std::size_t first);

}  // namespace misfit::ms_io
