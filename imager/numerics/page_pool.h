#pragma once

#include <cstddef>

namespace misfit::imager {

/// Memory in huge pages, for large blocks. Pages that one block gives back are reused for others, whatever their sizes, since
/// the system clears every page that it lends, which takes as long as gridding into it. The pool never holds more than blocks
/// had taken at once.
class PagePool {
 public:
  static constexpr std::size_t page_bytes = std::size_t{1} << 21;

  /// A block of that many bytes, in whole pages and not initialised; null where the system has no room.
  static void* take(std::size_t bytes) noexcept;
  /// Takes a block that will be written to as a whole. The pages that the system has to clear for it are cleared now, by as
  /// many threads as fill_by was given.
  static void* take_to_fill(std::size_t bytes) noexcept;
  /// Threads that take_to_fill may use; one before the first call.
  static void fill_by(int threads) noexcept;
  /// Gives `memory` back if it is a block taken before; returns whether it is.
  static bool give(void* memory) noexcept;
  /// Gives spare pages back to the system.
  static void release() noexcept;
};

}  // namespace misfit::imager
