#include <algorithm>
#include <vector>

#include "ms_io/stored_arrays_internal.h"

namespace misfit::ms_io {

StoredArrays::StoredArrays(const std::string& path, ByteOrder order) : bytes_(path), order_(order) {
  counts_references_ = ObjectReader(bytes_, order).number(4) > 0;
}

void StoredArrays::check_column(const StoredColumn& column) const {
  constexpr std::uint64_t any_bytes = 1 << 20;  // it may have no rows
  const double values = column.has_shape ? product(column.shape, bytes_, "cells of " + column.name) : 0;
  if (values * static_cast<double>(bits_of(column.type)) / 8 > static_cast<double>(std::max(any_bytes, bytes_.size())))
    bytes_.fail("cells of " + column.name + " of " + shown(values) + " values", "no more than it holds");
}

void StoredArrays::check(std::int64_t place, const StoredColumn& column) {
  constexpr std::uint64_t quick = 1 << 30;
  if (place == 0 || bytes_.size() > quick) return;
  const auto at = static_cast<std::uint64_t>(place);
  const std::uint64_t head = counts_references_ ? 8 : 4;
  if (place < 0 || at > bytes_.size() || bytes_.size() - at < head)
    bytes_.fail("an array at byte " + std::to_string(place), "one of its " + std::to_string(bytes_.size()));
  ObjectReader in(bytes_, order_, at);
  if (counts_references_) in.number(4);
  std::vector<std::int64_t> shape(in.count(4, "axes", 4));
  for (std::int64_t& length : shape) length = in.integer(4);
  const double values = check_values(in, shape, column.type);
  if (column.has_shape && shape != column.shape) bytes_.fail("a cell of " + column.name + " of another shape", "that of all");
  if (column.type != casacore::TpString) return;
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
