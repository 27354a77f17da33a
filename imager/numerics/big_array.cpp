#include "imager/numerics/big_array.h"

#include <sys/mman.h>

#include <cstdlib>
#include <mutex>
#include <new>
#include <utility>

namespace misfit::imager {

/// One block, the largest that was given back.
struct BigMemory::Spare {
  std::mutex mutex;
  Block block;

  Block take() {
    const std::lock_guard lock(mutex);
    return std::exchange(block, Block());
  }
  void give(Block given) {
    const std::lock_guard lock(mutex);
    if (given.bytes > block.bytes) std::swap(block, given);
  }
};

BigMemory::Spare& BigMemory::spare() {
  static Spare one;
  return one;
}

void BigMemory::Free::operator()(void* memory) const {
  std::free(memory);
}

BigMemory::~BigMemory() {
  spare().give(std::move(block_));
}

void BigMemory::reserve(std::size_t bytes) {
  if (bytes <= block_.bytes) return;
  constexpr std::size_t huge_page = std::size_t{1} << 21, line = 64;
  const std::size_t page = bytes < huge_page ? line : huge_page;  // what is small shares pages
  const std::size_t whole = (bytes + page - 1) / page * page;
  block_ = Block();  // what is too small makes room first
  block_ = spare().take();
  if (whole <= block_.bytes) return;
  block_ = Block();
  block_.memory.reset(std::aligned_alloc(page, whole));
  if (!block_.memory) throw std::bad_alloc();
  block_.bytes = whole;
  if (page == huge_page) madvise(block_.memory.get(), whole, MADV_HUGEPAGE);  // a hint: without it small pages serve
}

void BigMemory::release() {
  spare().take();
}

}  // namespace misfit::imager
