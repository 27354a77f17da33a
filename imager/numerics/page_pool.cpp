#include "imager/numerics/page_pool.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

namespace misfit::imager {
namespace {

constexpr std::size_t page_bytes = PagePool::page_bytes;

/// Takes memory of the C library, since operator new may itself take that of the pool.
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

/// Whole pages, one after the other, that the system knows as one mapping: before Linux 6.17 only such can be moved at once.
struct Pages {
  char* begin;
  std::size_t bytes;
};
using Pieces = std::vector<Pages, PlainAllocator<Pages>>;

void give_to_system(const Pieces& pieces) {
  for (const Pages& pages : pieces) munmap(pages.begin, pages.bytes);
}

/// Fresh pages; null where there is no room.
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
  std::map<void*, Pieces, std::less<>, PlainAllocator<std::pair<void* const, Pieces>>> taken;
  Pieces spare;

  /// A block of whole pages, of spare ones as far as there are; none where there is no room.
  Pieces block(std::size_t bytes) {
    Pieces pieces;
    pieces.reserve(spare.size() + 1);
    char* at = pages_of_system(bytes);
    if (at == nullptr) return pieces;
    for (char* const end = at + bytes; at < end;) {
      if (spare.empty()) {
        pieces.push_back({at, static_cast<std::size_t>(end - at)});
        break;
      }
      const std::size_t moved = std::min(static_cast<std::size_t>(end - at), spare.back().bytes);
      Pages& from = spare.back();
      if (mremap(from.begin, moved, moved, MREMAP_MAYMOVE | MREMAP_FIXED, at) == MAP_FAILED) {
        // The system may have lent the pages at `at` to another thread by now: they are left alone.
        pieces.push_back({at + moved, static_cast<std::size_t>(end - at) - moved});
        give_to_system(pieces);
        return {};
      }
      pieces.push_back({at, moved});
      from.begin += moved, from.bytes -= moved, at += moved;
      if (from.bytes == 0) spare.pop_back();
    }
    return pieces;
  }
};

/// It outlasts what is destroyed at the end of the program.
Pool& pool() {
  alignas(Pool) static char room[sizeof(Pool)];
  static Pool* const one = new (room) Pool;
  return *one;
}

}  // namespace

void* PagePool::take(std::size_t bytes) noexcept try {
  const std::size_t whole = (bytes + page_bytes - 1) / page_bytes * page_bytes;
  if (whole < bytes || whole == 0) return nullptr;
  Pool& p = pool();
  const std::lock_guard lock(p.mutex);
  Pieces block = p.block(whole);
  if (block.empty()) {
    give_to_system(p.spare);
    p.spare.clear();
    block = p.block(whole);
  }
  if (block.empty()) return nullptr;
  void* const begin = block.front().begin;
  p.taken.emplace(begin, std::move(block));
  return begin;
} catch (const std::bad_alloc&) {
  return nullptr;
}

bool PagePool::give(void* memory) noexcept {
  constexpr std::size_t most_pieces = 4096;  // a process may have some 65 000
  if (memory == nullptr || reinterpret_cast<std::uintptr_t>(memory) % page_bytes != 0) return false;
  Pool& p = pool();
  const std::lock_guard lock(p.mutex);
  const auto found = p.taken.find(memory);
  if (found == p.taken.end()) return false;
  const Pieces pieces = std::move(found->second);
  p.taken.erase(found);
  try {
    if (p.spare.size() + pieces.size() > most_pieces) throw std::bad_alloc();
    p.spare.insert(p.spare.end(), pieces.begin(), pieces.end());
  } catch (const std::bad_alloc&) {
    give_to_system(pieces);
  }
  return true;
}

void PagePool::release() noexcept {
  Pool& p = pool();
  Pieces spare;
  {
    const std::lock_guard lock(p.mutex);
    spare.swap(p.spare);
  }
  give_to_system(spare);
}

}  // namespace misfit::imager
