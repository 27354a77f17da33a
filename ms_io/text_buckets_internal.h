#pragma once

#include <cstdint>

#include "ms_io/buckets_internal.h"

namespace misfit::ms_io {

/// The texts of casacore's StandardStMan, which lie one after the other in buckets of their own, and go on in the next where
/// one ends. Each bucket begins with four numbers: the second is how many bytes of it are used, the fourth the bucket after it.
/// Every function throws std::runtime_error that names the file where texts go on in no bucket, or beyond the used bytes of
/// one.
class TextBuckets {
 public:
  TextBuckets(StoredBytes& bytes, const Buckets& buckets) : bytes_(bytes), buckets_(buckets) {}

  /// Goes to a place in a bucket, from which as many bytes are read, at most.
  void go(std::int64_t bucket, std::int64_t offset, std::uint64_t left);
  std::uint64_t left() const { return left_; }
  void skip(std::uint64_t count);
  std::int64_t number();

 private:
  void enter(std::int64_t bucket);
  void next();

  StoredBytes& bytes_;
  const Buckets& buckets_;
  std::int64_t bucket_ = -1;
  std::uint64_t place_ = 0, left_ = 0;
  std::int64_t used_ = 0, next_ = 0, offset_ = 0;
};

}  // namespace misfit::ms_io
