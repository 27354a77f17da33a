#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "ms_io/buckets_internal.h"
#include "ms_io/incremental_headers_internal.h"
#include "ms_io/stored_arrays_internal.h"

namespace misfit::ms_io {
namespace {

/// Reads in the order in which casacore (ISMBase, ISMIndex, ISMBucket) does.
class IncrementalStorage {
 public:
  IncrementalStorage(const std::string& path, const TableFile& table, const StorageManager& manager)
      : table_(table), columns_(columns_of(table, manager)), path_(file_of(path, manager)), bytes_(path_) {
    StoredBytes kept(path + "/table.dat", manager.kept);
    ObjectReader in(kept);
    in.magic();
    version_ = in.object("ISM");
    in.text();
    read_header();
  }

  void check() {
    const bool has_arrays =
        std::any_of(columns_.begin(), columns_.end(), [](const StoredColumn& c) { return c.is_array && !c.in_place; });
    constexpr std::uint64_t first_with_one_file = 3;
    if (has_arrays && version_ < first_with_one_file)
      bytes_.fail("arrays of version " + std::to_string(version_), std::to_string(first_with_one_file) + " or later");
    if (has_arrays) arrays_ = std::make_unique<StoredArrays>(path_ + "i", table_.order);
    for (const StoredColumn& column : columns_) {
      if (column.is_array && !column.in_place) arrays_->check_column(column);
      if (bytes_in_place(column) > static_cast<double>(buckets_->size()))
        bytes_.fail("cells of " + column.name + " of " + shown(bytes_in_place(column)) + " bytes", "no more than a bucket");
    }
    for (std::size_t i = 0; i + 1 < first_row_.size(); ++i) check_bucket(bucket_[i], first_row_[i + 1] - first_row_[i]);
  }

 private:
  void read_header() {
    ObjectReader in(bytes_, table_.order);
    in.magic();
    const std::uint64_t begin = in.at(), version = in.object("IncrementalStMan");
    if (version == 3) version_ = version;  // written so by one release of casacore
    if (version > 4) in.number(1);
    const std::uint64_t size = in.number(4), count = in.number(4), cached = in.number(4);
    in.skip(version > 1 ? 12 : 4);
    in.end(begin);
    buckets_ = std::make_unique<Buckets>(bytes_, size, count, cached);
    read_index(ObjectReader(bytes_, table_.order, Buckets::begin + size * count));
  }

  void read_index(ObjectReader in) {
    in.magic();
    const std::uint64_t begin = in.at(), version = in.object("ISMIndex"), used = in.number(4);
    first_row_ = in.block("rows", version > 1 ? 8 : 4);
    bucket_ = in.block("buckets");
    in.end(begin);
    if (used > bucket_.size() || used + 1 > first_row_.size())
      bytes_.fail(std::to_string(used) + " runs of rows", "no more than it has buckets for");
    first_row_.resize(used + 1);
    const bool is_empty_run = used == 1 && table_.rows == 0;
    const bool ascends = std::adjacent_find(first_row_.begin(), first_row_.end(), std::greater_equal<>()) == first_row_.end();
    if (!(ascends || is_empty_run) || first_row_.front() != 0 || first_row_.back() != table_.rows)
      bytes_.fail("rows up to " + std::to_string(first_row_.back()), "from 0 up to the table's " + std::to_string(table_.rows));
  }

  /// The number of values in a cell.
  double values_of(const StoredColumn& column) const {
    return column.is_array ? product(column.shape, bytes_, "cells of " + column.name) : 1;
  }

  /// The bytes of a cell's value in a bucket; for texts, the fewest that they take.
  double bytes_in_place(const StoredColumn& column) const {
    constexpr double place_of_array = 8;
    if (column.is_array && !column.in_place) return place_of_array;
    return std::ceil(values_of(column) * static_cast<double>(bits_of(column.type)) / 8);
  }

  /// A bucket has the place of its index, the values, and the index: for each column the number of values, and the first row
  /// and the place of each.
  void check_bucket(std::uint64_t bucket, std::uint64_t rows) {
    StoredBytes bytes(path_, bytes_.read(buckets_->at(bucket), buckets_->size()));
    constexpr std::uint64_t wide_rows = 0xf0000000;
    const std::uint64_t start = ObjectReader(bytes, table_.order).number(4), index = start & ~wide_rows;
    if (index < 4 || index > bytes.size()) fail_bucket(bucket, "an index at byte " + std::to_string(index));
    ObjectReader in(bytes, table_.order, index);
    for (const StoredColumn& column : columns_) {
      const std::uint64_t count = in.left() < 4 ? rows + 1 : in.number(4), size = (start & wide_rows) != 0 ? 8 : 4;
      if (count > in.left() / (size + 4) || (rows > 0 && count == 0))
        fail_bucket(bucket, std::to_string(count) + " values of " + column.name);
      for (std::uint64_t i = 0; i < count; ++i)
        if (const std::uint64_t row = in.number(size); row > rows || (i == 0) != (row == 0))
          fail_bucket(bucket, column.name + " from row " + std::to_string(row) + " on");
      for (std::uint64_t i = 0; i < count; ++i) check_value(bytes, column, 4 + in.number(4), index, bucket);
    }
  }

  void check_value(StoredBytes& bytes, const StoredColumn& column, std::uint64_t at, std::uint64_t end, std::uint64_t bucket) {
    if (at > end || bytes_in_place(column) > static_cast<double>(end - at))
      fail_bucket(bucket, column.name + " at byte " + std::to_string(at));
    ObjectReader in(bytes, table_.order, at);
    if (column.is_array && !column.in_place) return arrays_->check(in.integer(8), column);
    if (column.type != casacore::TpString) return;
    const double values = values_of(column);
    const std::uint64_t length = in.number(4);
    std::uint64_t left = length > end - at || length < 4 ? 0 : length - 4;
    bool within = (length >= 4 || values == 0) && length <= end - at;
    for (double i = 0; within && values > 1 && i < values; ++i) {
      const std::uint64_t text = left < 4 ? left + 1 : 4 + in.number(4);
      within = text <= left;
      if (!within) break;
      left -= text;
      in.skip(text - 4);
    }
    if (!within) fail_bucket(bucket, column.name + " of " + std::to_string(length) + " bytes");
  }

  [[noreturn]] void fail_bucket(std::uint64_t bucket, const std::string& tells) const {
    bytes_.fail(tells + " in bucket " + std::to_string(bucket), "what it holds");
  }

  const TableFile& table_;
  std::vector<StoredColumn> columns_;
  std::string path_;
  StoredBytes bytes_;
  std::uint64_t version_ = 0;
  std::unique_ptr<Buckets> buckets_;
  std::vector<std::uint64_t> first_row_, bucket_;
  std::unique_ptr<StoredArrays> arrays_;
};

}  // namespace

void check_incremental_header(const std::string& path, const TableFile& table, const StorageManager& manager) {
  IncrementalStorage(path, table, manager).check();
}

}  // namespace misfit::ms_io
