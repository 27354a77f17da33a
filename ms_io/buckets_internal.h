#pragma once

#include <cstdint>

#include "ms_io/stored_bytes_internal.h"

namespace misfit::ms_io {

/// Buckets of one size, in which casacore's StandardStMan and IncrementalStMan keep rows, after a header.
class Buckets {
 public:
  static constexpr std::uint64_t begin = 512;

  /// Throws std::runtime_error where a header states more or larger buckets than its file holds, or a larger cache than there
  /// may be.
  Buckets(StoredBytes& bytes, std::uint64_t size, std::uint64_t count, std::uint64_t cached);

  std::uint64_t size() const { return size_; }
  std::uint64_t count() const { return count_; }
  /// The place of a bucket in the file; throws std::runtime_error where there is no such bucket.
  std::uint64_t at(std::uint64_t bucket) const;

 private:
  StoredBytes& bytes_;
  std::uint64_t size_, count_;
};

}  // namespace misfit::ms_io
