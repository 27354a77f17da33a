#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace misfit::imager {

/// Memory for grids, not initialised, in huge pages where the system lends them: a tile's rows lie pages apart.
template <typename T>
class BigArray {
 public:
  /// Room for `count` values, their content lost where more room is needed.
  void reserve(std::size_t count) {
    if (count <= capacity_) return;
    constexpr std::size_t huge_page = std::size_t{1} << 21;
    const std::size_t bytes = (count * sizeof(T) + huge_page - 1) / huge_page * huge_page;
    memory_.reset();
    memory_.reset(static_cast<T*>(std::aligned_alloc(huge_page, bytes)));
    if (!memory_) throw std::bad_alloc();
    madvise(memory_.get(), bytes, MADV_HUGEPAGE);  // a hint: without it small pages serve
    capacity_ = count;
  }
  T* data() { return memory_.get(); }
  const T* data() const { return memory_.get(); }

 private:
  struct Free {
    void operator()(T* memory) const { std::free(memory); }
  };
  std::unique_ptr<T, Free> memory_;
  std::size_t capacity_ = 0;
};

}  // namespace misfit::imager
