#pragma once

#include <cstddef>
#include <memory>

namespace misfit::imager {

/// Memory for grids, not initialised, in huge pages where it fills any: a tile's rows lie pages apart.
class BigMemory {
 public:
  BigMemory() = default;
  BigMemory(const BigMemory&) = delete;
  BigMemory& operator=(const BigMemory&) = delete;

  /// Makes room for that many bytes; the content is lost where more room is needed.
  void reserve(std::size_t bytes);
  void* data() { return memory_.get(); }
  const void* data() const { return memory_.get(); }

 private:
  struct Free {
    void operator()(void* memory) const;
  };

  std::unique_ptr<void, Free> memory_;
  std::size_t bytes_ = 0;
};

/// BigMemory as an array of values.
template <typename T>
class BigArray {
 public:
  void reserve(std::size_t count) { memory_.reserve(count * sizeof(T)); }
  T* data() { return static_cast<T*>(memory_.data()); }
  const T* data() const { return static_cast<const T*>(memory_.data()); }

 private:
  BigMemory memory_;
};

}  // namespace misfit::imager
