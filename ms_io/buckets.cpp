#include <algorithm>

#include "ms_io/buckets_internal.h"

namespace misfit::ms_io {

Buckets::Buckets(StoredBytes& bytes, std::uint64_t size, std::uint64_t count, std::uint64_t cached)
    : bytes_(bytes), size_(size), count_(count) {
  constexpr std::uint64_t smallest = 32, any_size = 1 << 24, any_cached = 1 << 20;
  const std::uint64_t held = bytes.size() > begin ? bytes.size() - begin : 0;
  if (size < smallest || size > std::max(any_size, held))
    bytes.fail("buckets of " + std::to_string(size) + " bytes",
               std::to_string(smallest) + " or more, and no more than it holds");
  if (count > held / size) bytes.fail(std::to_string(count) + " buckets", "no more than it holds");
  if (cached > std::max(any_cached, count)) bytes.fail(std::to_string(cached) + " buckets in memory", "no more than it holds");
}

std::uint64_t Buckets::at(std::uint64_t bucket) const {
  if (bucket >= count_) bytes_.fail("bucket " + std::to_string(bucket), "one of its " + std::to_string(count_));
  return begin + bucket * size_;
}

}  // namespace misfit::ms_io
