#include <algorithm>
#include <memory>

#include "ms_io/buckets_internal.h"
#include "ms_io/standard_headers_internal.h"
#include "ms_io/stored_arrays_internal.h"
#include "ms_io/text_buckets_internal.h"

namespace misfit::ms_io {
namespace {

/// Reads in the order in which casacore (SSMBase, SSMIndex, SSMStringHandler) does.
class StandardStorage {
 public:
  StandardStorage(const std::string& path, const TableFile& table, const StorageManager& manager)
      : table_(table), columns_(columns_of(table, manager)), path_(file_of(path, manager)), bytes_(path_) {
    read_kept({path + "/table.dat", manager.kept});
    read_header();
  }

  void check() const {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      check_column(c);
      if (is_text(columns_[c])) check_texts(c);
      if (columns_[c].is_array && !columns_[c].in_place && !is_text(columns_[c])) check_arrays(c);
    }
  }

 private:
  /// Rows [begin, end) and their bucket.
  struct Run {
    std::uint64_t begin = 0, end = 0, bucket = 0;
  };
  struct Index {
    std::uint64_t rows_per_bucket = 0;
    std::vector<Run> runs;
  };

  void read_kept(StoredBytes bytes) {
    ObjectReader in(bytes);
    in.magic();
    in.object("SSM");
    in.text();
    offsets_ = in.block("offsets of columns");
    index_of_ = in.block("indices of columns");
    if (std::min(offsets_.size(), index_of_.size()) < columns_.size()) throw Malformed{bytes.path()};
  }

  void read_header() {
    ObjectReader in(bytes_, table_.order);
    in.magic();
    const std::uint64_t begin = in.at(), version = in.object("StandardStMan");
    if (version > 2) in.number(1);
    const std::uint64_t size = in.number(4), count = in.number(4), cached = in.number(4);
    buckets_ = std::make_unique<Buckets>(bytes_, size, count, cached);
    in.skip(8);
    const std::uint64_t index_buckets = in.number(4), first = in.number(4), offset = version > 1 ? in.number(4) : 0;
    in.number(4);
    const std::uint64_t length = in.number(4), indices = in.number(4);
    in.end(begin);
    StoredBytes gathered(path_, index_bytes(index_buckets, first, offset, length));
    constexpr std::uint64_t smallest = 64;
    if (indices > length / smallest) bytes_.fail(std::to_string(indices) + " indices of rows", "no more than it holds");
    ObjectReader index(gathered, table_.order);
    for (std::uint64_t i = 0; i < indices; ++i) indices_.push_back(read_index(index));
  }

  /// The bytes of the index, from the buckets that hold it: each begins with the number of the next, twice, or the index is
  /// part of one bucket.
  std::string index_bytes(std::uint64_t buckets, std::uint64_t first, std::uint64_t offset, std::uint64_t length) {
    constexpr std::uint64_t link = 8;
    const std::uint64_t room = buckets_->size() - link;
    const std::uint64_t needed = offset > 0 ? 1 : (length + room - 1) / room;
    if (buckets != needed || (offset > 0 && offset + length > buckets_->size()) || needed > buckets_->count())
      bytes_.fail("an index of " + std::to_string(length) + " bytes in " + std::to_string(buckets) + " buckets",
                  "one within them");
    if (offset > 0) return bytes_.read(buckets_->at(first) + offset, length);
    std::string all;
    for (std::uint64_t bucket = first; all.size() < length;) {
      const std::uint64_t at = buckets_->at(bucket);
      bucket = ObjectReader(bytes_, ByteOrder::big, at + 4).number(4);
      all += bytes_.read(at + link, std::min(room, length - all.size()));
    }
    return all;
  }

  Index read_index(ObjectReader& in) {
    in.magic();
    const std::uint64_t begin_of_index = in.at(), version = in.object("SSMIndex"), used = in.number(4);
    Index index;
    index.rows_per_bucket = in.number(4);
    in.number(4);
    skip_free_space(in);
    const std::vector<std::uint64_t> last = in.block("last rows", version == 1 ? 4 : 8), bucket = in.block("buckets");
    in.end(begin_of_index);
    if (used > std::min(last.size(), bucket.size()))
      bytes_.fail(std::to_string(used) + " runs of rows", "no more than it has buckets for");
    for (std::size_t i = 0; i < used; ++i) {
      const std::uint64_t begin = i == 0 ? 0 : index.runs.back().end, end = last[i] + 1;
      if (end < begin || end == 0 || end - begin > index.rows_per_bucket)
        bytes_.fail("rows " + std::to_string(begin) + " to " + std::to_string(last[i]) + " in a bucket",
                    "at most " + std::to_string(index.rows_per_bucket));
      index.runs.push_back({begin, end, bucket[i]});
    }
    return index;
  }

  static void skip_free_space(ObjectReader& in) {
    const std::uint64_t begin = in.at();
    in.object("SimpleOrderedMap");
    in.number(4);
    const std::uint64_t gaps = in.count(4, "gaps", 8);
    in.number(4);
    in.skip(8 * gaps);
    in.end(begin);
  }

  static bool is_text(const StoredColumn& column) { return column.type == casacore::TpString && !has_fixed_length(column); }
  static bool has_fixed_length(const StoredColumn& column) { return !column.is_array && column.longest_text > 0; }

  /// The bits of a cell among other columns.
  double bits_in_place(const StoredColumn& column) const {
    constexpr double place_of_text = 96, place_of_array = 64;
    if (is_text(column)) return place_of_text;
    if (column.type == casacore::TpString) return 8 * static_cast<double>(column.longest_text);
    if (!column.is_array) return static_cast<double>(bits_of(column.type));
    if (!column.in_place) return place_of_array;
    return product(column.shape, bytes_, "cells of " + column.name) * static_cast<double>(bits_of(column.type));
  }

  void check_column(std::size_t c) const {
    if (index_of_[c] >= indices_.size())
      bytes_.fail("rows in index " + std::to_string(index_of_[c]), "one of " + std::to_string(indices_.size()));
    const Index& index = indices_[index_of_[c]];
    const double bits = static_cast<double>(index.rows_per_bucket) * bits_in_place(columns_[c]);
    if (static_cast<double>(offsets_[c]) + bits / 8 > static_cast<double>(buckets_->size()))
      bytes_.fail(
          shown(bits / 8) + " bytes of " + columns_[c].name + " at byte " + std::to_string(offsets_[c]) + " of a bucket",
          "all of them in its " + std::to_string(buckets_->size()));
    for (const Run& run : index.runs) buckets_->at(run.bucket);
    if (const std::uint64_t rows = index.runs.empty() ? 0 : index.runs.back().end; rows != table_.rows)
      bytes_.fail(std::to_string(rows) + " rows of " + columns_[c].name, "the table's " + std::to_string(table_.rows));
    if (is_text(columns_[c]) && product(columns_[c].shape, bytes_, "cells of " + columns_[c].name) > most_texts())
      bytes_.fail("cells of " + columns_[c].name + " of more texts", "no more than it holds");
  }
  /// The most texts of an array, empty ones included.
  double most_texts() const {
    constexpr std::uint64_t any_empty = 1 << 16;
    return static_cast<double>(std::max(any_empty, bytes_.size() / 4));
  }

  /// Calls `action` with a reader at each cell of the column.
  template <typename Action>
  void for_each_cell(std::size_t c, std::uint64_t bytes, const Action& action) const {
    for (const Run& run : indices_[index_of_[c]].runs) {
      StoredBytes cells(path_, bytes_.read(buckets_->at(run.bucket) + offsets_[c], bytes * (run.end - run.begin)));
      for (std::uint64_t row = run.begin; row < run.end; ++row) {
        ObjectReader in(cells, table_.order, bytes * (row - run.begin));
        action(in);
      }
    }
  }

  void check_arrays(std::size_t c) const {
    StoredArrays arrays(path_ + "i", table_.order);
    arrays.check_column(columns_[c]);
    for_each_cell(c, 8, [&](ObjectReader& in) { arrays.check(in.integer(8), columns_[c]); });
  }

  /// Checks cells of texts: a cell has the bucket of its text, the place there and the length, or a short text; each text has a
  /// place of its own.
  void check_texts(std::size_t c) const {
    constexpr std::int64_t longest_in_place = 8;
    TextBuckets texts(bytes_, *buckets_);
    std::uint64_t left = bytes_.size();
    for_each_cell(c, 12, [&](ObjectReader& in) {
      const std::int64_t bucket = in.integer(4), offset = in.integer(4), length = in.integer(4);
      const bool elsewhere = length > (columns_[c].is_array ? 0 : longest_in_place);
      if (length < 0 || (elsewhere && static_cast<std::uint64_t>(length) > left))
        bytes_.fail("a text of " + std::to_string(length) + " bytes of " + columns_[c].name, "no more than it holds");
      if (!elsewhere) return;
      left -= static_cast<std::uint64_t>(length);
      texts.go(bucket, offset, static_cast<std::uint64_t>(length));
      if (columns_[c].is_array)
        check_array_of_texts(texts, columns_[c]);
      else
        texts.skip(texts.left());
    });
  }

  /// Checks an array of texts: it states its shape where the column has none, and whether it has its texts.
  void check_array_of_texts(TextBuckets& texts, const StoredColumn& column) const {
    std::vector<std::int64_t> shape = column.shape;
    bool filled = true;
    if (!column.has_shape) {
      const std::int64_t axes = texts.number();
      if (axes < 0 || static_cast<std::uint64_t>(axes) > texts.left() / 4)
        bytes_.fail("an array of " + std::to_string(axes) + " axes", "no more than it holds");
      for (std::int64_t axis = 0; axis < axes; ++axis) shape.push_back(texts.number());
      filled = texts.number() != 0;
    }
    const double values = product(shape, bytes_, "an array of texts");
    if (values > (filled ? static_cast<double>(texts.left() / 4) : most_texts()))
      bytes_.fail("an array of " + shown(values) + " texts of " + column.name, "no more than it holds");
    for (double i = 0; filled && i < values; ++i) {
      const std::int64_t length = texts.number();
      texts.skip(length < 0 ? texts.left() + 1 : static_cast<std::uint64_t>(length));
    }
  }

  const TableFile& table_;
  std::vector<StoredColumn> columns_;
  std::string path_;
  mutable StoredBytes bytes_;
  std::unique_ptr<Buckets> buckets_;
  std::vector<std::uint64_t> offsets_, index_of_;  ///< of columns
  std::vector<Index> indices_;
};

}  // namespace

void check_standard_header(const std::string& path, const TableFile& table, const StorageManager& manager) {
  StandardStorage(path, table, manager).check();
}

}  // namespace misfit::ms_io
