#include <algorithm>

#include "ms_io/text_buckets_internal.h"

namespace misfit::ms_io {
namespace {

constexpr std::uint64_t head = 16;

}  // namespace

void TextBuckets::go(std::int64_t bucket, std::int64_t offset, std::uint64_t left) {
  enter(bucket);
  if (offset < 0 || offset > used_) bytes_.fail("a text at byte " + std::to_string(offset), "one of a bucket's");
  offset_ = offset;
  left_ = left;
}

void TextBuckets::skip(std::uint64_t count) {
  if (count > left_) bytes_.fail("texts of more bytes", "no more than their length");
  left_ -= count;
  while (count > 0) {
    const std::uint64_t here = std::min(count, static_cast<std::uint64_t>(used_ - offset_));
    count -= here;
    offset_ += static_cast<std::int64_t>(here);
    if (count > 0) next();
  }
}

std::int64_t TextBuckets::number() {
  std::uint32_t value = 0;
  for (int byte = 0; byte < 4; ++byte) {
    if (offset_ == used_) next();
    value = value << 8 | static_cast<unsigned char>(bytes_.read(place_ + head + static_cast<std::uint64_t>(offset_), 1)[0]);
    skip(1);
  }
  return static_cast<std::int32_t>(value);
}

void TextBuckets::enter(std::int64_t bucket) {
  if (bucket == bucket_) return;
  place_ = buckets_.at(bucket < 0 ? buckets_.count() : static_cast<std::uint64_t>(bucket));
  ObjectReader in(bytes_, ByteOrder::big, place_ + 4);
  used_ = in.integer(4);
  in.number(4);
  next_ = in.integer(4);
  if (used_ < 0 || static_cast<std::uint64_t>(used_) > buckets_.size() - head)
    bytes_.fail("a bucket of texts of " + std::to_string(used_) + " bytes", "no more than it has");
  bucket_ = bucket;
}

void TextBuckets::next() {
  enter(next_);
  offset_ = 0;
  if (used_ == 0) bytes_.fail("texts that go on in an empty bucket", "the rest of them");
}

}  // namespace misfit::ms_io
