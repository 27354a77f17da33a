#include "imager/numerics/page_pool.h"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <mutex>
#include <new>
#include <thread>
#include <utility>
#include <vector>

namespace misfit::imager {
namespace {

constexpr std::size_t page_bytes = PagePool::page_bytes;

/// Takes memory of the C library, since operator new may itself take memory of the pool.
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

  /// A block of whole pages, spare ones first; none where there is no room.
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

/// The pool outlasts objects that are destroyed at the end of the program.
Pool& pool() {
  alignas(Pool) static char room[sizeof(Pool)];
  static Pool* const one = new (room) Pool;
  return *one;
}

std::atomic<int> filling_threads{1};

/// Has the system lend and clear pages now. Where it cannot, it does so when they are written to.
void clear([[maybe_unused]] const Pages& fresh) noexcept {
#ifdef MADV_POPULATE_WRITE  // Linux 5.14
  const std::size_t pages = fresh.bytes / page_bytes;
  const std::size_t threads = std::min(static_cast<std::size_t>(std::max(1, filling_threads.load())), pages);
  if (threads < 2) return;
  const auto clear_part = [&](std::size_t i) {
    const std::size_t begin = pages * i / threads * page_bytes, end = pages * (i + 1) / threads * page_bytes;
    madvise(fresh.begin + begin, end - begin, MADV_POPULATE_WRITE);
  };
  std::vector<std::thread> others;
  try {
    others.reserve(threads);
    for (std::size_t i = 1; i < threads; ++i) others.emplace_back(clear_part, i);
  } catch (const std::exception&) {  // what no thread takes is cleared later
  }
  clear_part(0);
  for (std::thread& other : others) other.join();
#endif
}

/// Whole pages, and those at their end that the system may not have lent yet; null where there is no room.
struct Block {
  void* begin = nullptr;
  Pages fresh{};
};

Block take_block(std::size_t bytes) noexcept try {
  const std::size_t whole = (bytes + page_bytes - 1) / page_bytes * page_bytes;
  if (whole < bytes || whole == 0) return {};
  Pool& p = pool();
  const std::lock_guard lock(p.mutex);
  Pieces block = p.block(whole);
  if (block.empty()) {
    give_to_system(p.spare);
    p.spare.clear();
    block = p.block(whole);
  }
  if (block.empty()) return {};
  const Block taken{block.front().begin, p.spare.empty() ? block.back() : Pages{}};
  p.taken.emplace(taken.begin, std::move(block));
  return taken;
} catch (const std::bad_alloc&) {
  return {};
}

}  // namespace

void* PagePool::take(std::size_t bytes) noexcept {
  return take_block(bytes).begin;
}

void* PagePool::take_to_fill(std::size_t bytes) noexcept {
  const Block block = take_block(bytes);
  if (block.fresh.bytes > 0) clear(block.fresh);
  return block.begin;
}

void PagePool::fill_by(int threads) noexcept {
  filling_threads = threads;
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
