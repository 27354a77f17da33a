#include "imager/numerics/big_array.h"

#include <cstdlib>
#include <new>

#include "imager/numerics/page_pool.h"

namespace misfit::imager {

void BigMemory::Free::operator()(void* memory) const {
  if (!PagePool::give(memory)) std::free(memory);
}

void BigMemory::reserve(std::size_t bytes) {
  if (bytes <= bytes_) return;
  constexpr std::size_t line = 64;
  memory_.reset();  // memory that is too small is freed first
  bytes_ = 0;
  const std::size_t lines = (bytes + line - 1) / line * line;
#ifdef MISFIT_SANITIZED  // sanitizers watch the C library's memory alone
  constexpr bool may_share_pages = true;
#else
  const bool may_share_pages = bytes < PagePool::page_bytes;
#endif
  memory_.reset(may_share_pages ? std::aligned_alloc(line, lines) : PagePool::take(bytes));
  if (!memory_) throw std::bad_alloc();
  bytes_ = bytes;
}

}  // namespace misfit::imager
