// Gives images, and what else is large, memory in huge pages where the system lends them: pages fresh from the system, half a
// thousand times as many small ones, took an eighth of a CLEAN run's time.
#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define MISFIT_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define MISFIT_SANITIZED
#endif
#endif

#ifndef MISFIT_SANITIZED  // sanitizers watch operators of their own

namespace {

void* allocate(std::size_t bytes) noexcept {
  constexpr std::size_t huge_page = std::size_t{1} << 21, large = 8 * huge_page;
  if (bytes < large) return std::malloc(bytes == 0 ? 1 : bytes);
  const std::size_t whole = bytes + (huge_page - 1);
  if (whole < bytes) return nullptr;
  void* const memory = std::aligned_alloc(huge_page, whole / huge_page * huge_page);
  if (memory != nullptr) madvise(memory, bytes, MADV_HUGEPAGE);  // a hint
  return memory;
}

}  // namespace

void* operator new(std::size_t bytes) {
  while (true) {
    if (void* const memory = allocate(bytes); memory != nullptr) return memory;
    const std::new_handler make_room = std::get_new_handler();
    if (make_room == nullptr) throw std::bad_alloc();
    make_room();
  }
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

#endif
