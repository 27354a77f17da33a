#pragma once

#include <cstddef>
#include <memory>

namespace misfit::imager {

/// Memory for grids, not initialised, in huge pages where the system lends them: a tile's rows lie pages apart. What one grid
/// gives back the next one takes, since pages fresh from the system are as dear as gridding into them.
class BigMemory {
 public:
  BigMemory() = default;
  BigMemory(const BigMemory&) = delete;
  BigMemory& operator=(const BigMemory&) = delete;
  ~BigMemory();

  /// Room for that many bytes, their content lost where more room is needed.
  void reserve(std::size_t bytes);
  void* data() { return block_.memory.get(); }
  const void* data() const { return block_.memory.get(); }

  /// Gives what lies spare back to the system.
  static void release();

 private:
  struct Free {
    void operator()(void* memory) const;
  };
  struct Block {
    std::unique_ptr<void, Free> memory;
    std::size_t bytes = 0;
  };
  struct Spare;

  static Spare& spare();

  Block block_;
};

/// The same as an array of values.
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
