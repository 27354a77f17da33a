#pragma once

#include <cstddef>
#include <memory>

#include "imager/data/visibilities.h"

namespace misfit::imager {

/// `stream`, read in a thread of its own while the caller works: at most `ahead` blocks are being read or wait to be taken;
/// with 0 there is no thread. next() throws what the stream threw, in its turn. Destruction waits for the block being read.
std::unique_ptr<BlockStream> prefetched(std::unique_ptr<BlockStream> stream, std::size_t ahead);

}  // namespace misfit::imager
