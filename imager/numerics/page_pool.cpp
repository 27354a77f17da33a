#include "imager/numerics/page_pool.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <mutex>
#include <new>
#include <vector>

namespace misfit::imager {
namespace {

constexpr std::size_t page_bytes = PagePool::page_bytes;

/// Of the C library: operator new may be made of the pool.
template <typename T>
struct PlainAllocator {
  using value_type = T;
  PlainAllocator() = default;
  template <typename U>
  PlainAllocator(const PlainAllocator<U>& /*other*/) {}
  T* allocate(std::size_t count) {
    if (void* const memory = std::malloc(count * sizeof(T)); memory != nullptr) return static_cast<T*>(memory);
    throw std::bad_alloc();
  }
  void deallocate(T* memory, std::size_t /*count*/) { std::free(memory); }
  bool operator==(const PlainAllocator& /*other*/) const { return true; }
};

/// Whole pages, one after the other.
struct Pages {
  char* begin;
  std::size_t bytes;
};

/// Fresh ones, that begin at a multiple of their size; null where there is no room.
char* pages_of_system(std::size_t bytes) {
  void* const mapped = mmap(nullptr, bytes + page_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) return nullptr;
  char* const begin = static_cast<char*>(mapped);
  const std::size_t before = (page_bytes - reinterpret_cast<std::uintptr_t>(begin) % page_bytes) % page_bytes;
  if (before > 0) munmap(begin, before);
  munmap(begin + before + bytes, page_bytes - before);
  madvise(begin + before, bytes, MADV_HUGEPAGE);  // a hint: without it small pages serve
  return begin + before;
}

struct Pool {
  std::mutex mutex;
  std::map<void*, std::size_t, std::less<>, PlainAllocator<std::pair<void* const, std::size_t>>> taken;
  std::vector<Pages, PlainAllocator<Pages>> spare;

  void release() {
    for (const Pages& pages : spare) munmap(pages.begin, pages.bytes);
    spare.clear();
  }

  /// A block of whole pages, of spare ones as far as there are; null where there is no room.
  char* block(std::size_t bytes) {
    char* const begin = pages_of_system(bytes);
    for (char *at = begin, *const end = begin + bytes; begin != nullptr && at < end && !spare.empty();) {
      Pages& last = spare.back();
      const auto moved = std::min(static_cast<std::size_t>(end - at), last.bytes);
      last.bytes -= moved;
      if (mremap(last.begin + last.bytes, moved, moved, MREMAP_MAYMOVE | MREMAP_FIXED, at) == MAP_FAILED) {
        munmap(last.begin + last.bytes, moved);
        munmap(begin, bytes);
        return nullptr;
      }
      if (last.bytes == 0) spare.pop_back();
      at += moved;
    }
    return begin;
  }
};

/// It outlasts what is destroyed at the end of the program.
Pool& pool() {
  alignas(Pool) static char room[sizeof(Pool)];
  static Pool* const one = new (room) Pool;
  return *one;
}

}  // namespace

void* PagePool::take(std::size_t bytes) noexcept {
  const std::size_t whole = (bytes + page_bytes - 1) / page_bytes * page_bytes;
  if (whole < bytes) return nullptr;
  Pool& p = pool();
  const std::lock_guard lock(p.mutex);
  char* block = p.block(whole);
  if (block == nullptr) {
    p.release();
    block = p.block(whole);
  }
  if (block == nullptr) return nullptr;
  try {
    p.taken.emplace(block, whole);
  } catch (const std::bad_alloc&) {
    munmap(block, whole);
    return nullptr;
  }
  return block;
}

bool PagePool::give(void* memory) noexcept {
  if (memory == nullptr || reinterpret_cast<std::uintptr_t>(memory) % page_bytes != 0) return false;
  Pool& p = pool();
  const std::lock_guard lock(p.mutex);
  const auto found = p.taken.find(memory);
  if (found == p.taken.end()) return false;
  const Pages pages{static_cast<char*>(memory), found->second};
  p.taken.erase(found);
  try {
    p.spare.push_back(pages);
  } catch (const std::bad_alloc&) {
    munmap(pages.begin, pages.bytes);
  }
  return true;
}

void PagePool::release() noexcept {
  Pool& p = pool();
  const std::lock_guard lock(p.mutex);
  p.release();
}

}  // namespace misfit::imager
