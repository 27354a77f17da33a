#include <vector>

#include "ms_io/stored_arrays_internal.h"

namespace misfit::ms_io {

StoredArrays::StoredArrays(const std::string& path, ByteOrder order) : bytes_(path), order_(order) {
  counts_references_ = ObjectReader(bytes_, order).number(4) > 0;
}

void StoredArrays::check(std::int64_t place, casacore::DataType type) {
  constexpr std::uint64_t quick = 1 << 30;
  if (place == 0 || bytes_.size() > quick) return;
  const auto at = static_cast<std::uint64_t>(place);
  constexpr std::uint64_t head = 8;
  if (place < 0 || at > bytes_.size() || bytes_.size() - at < head)
    bytes_.fail("an array at byte " + std::to_string(place), "one of its " + std::to_string(bytes_.size()));
  ObjectReader in(bytes_, order_, at);
  if (counts_references_) in.number(4);
  std::vector<std::int64_t> shape(in.count(4, "axes", 4));
  for (std::int64_t& length : shape) length = in.integer(4);
  const double values = product(shape, bytes_, "an array");
  if (values * static_cast<double>(bits_of(type)) / 8 > static_cast<double>(in.left()))
    bytes_.fail("an array of " + shown(values) + " values", "no more than it holds");
  if (type != casacore::TpString) return;
  std::uint64_t left = bytes_.size();
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(values); ++i) {
    const std::uint64_t text = in.number(4);
    if (text == 0) continue;
    ObjectReader reader(bytes_, order_, text);
    const std::uint64_t length = reader.left() < 4 ? left + 1 : reader.count(4, "letters", 1);
    if (length > left) bytes_.fail("texts beyond it", "all of an array within it");
    left -= length;
  }
}

}  // namespace misfit::ms_io
