// Gives images, and all that is large, memory of the pool of pages: fresh pages from the system took a sixth of a CLEAN run's
// time.
#include "tools/operator_new.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <new>

#include "imager/numerics/page_pool.h"

#ifndef MISFIT_SANITIZED  // sanitizers watch their own operators

namespace {

bool begun = false;  ///< main

/// Ends the program: while libraries are loaded nobody catches an exception.
void end_before_main() noexcept {
  constexpr char message[] = "misfit: out of memory while the program is loaded; expected more of it\n";
  static_cast<void>(!write(STDERR_FILENO, message, sizeof message - 1));
  _exit(1);
}

/// Ends the program where there is no memory for libraries. They begin before main, and some crash or print a riddle without
/// memory.
void require_memory_for_libraries() noexcept {
  constexpr std::size_t some = std::size_t{4} << 20;
  void* const memory = mmap(nullptr, some, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) end_before_main();
  munmap(memory, some);
}
/// Run by the loader before anything of the libraries.
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_libraries)() = &require_memory_for_libraries;

void* allocate(std::size_t bytes) noexcept {
  constexpr std::size_t large = 8 * misfit::imager::PagePool::page_bytes;
  return bytes < large ? std::malloc(bytes == 0 ? 1 : bytes) : misfit::imager::PagePool::take_to_fill(bytes);
}

}  // namespace

void* operator new(std::size_t bytes) {
  while (true) {
    if (void* const memory = allocate(bytes); memory != nullptr) return memory;
    const std::new_handler make_room = std::get_new_handler();
    if (make_room == nullptr && !begun) end_before_main();
    if (make_room == nullptr) throw std::bad_alloc();
    make_room();
  }
}

void operator delete(void* memory) noexcept {
  if (!misfit::imager::PagePool::give(memory)) std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  operator delete(memory);
}

void misfit::tools::begin_to_throw_bad_alloc() noexcept {
  begun = true;
}

#else

void misfit::tools::begin_to_throw_bad_alloc() noexcept {}

#endif
