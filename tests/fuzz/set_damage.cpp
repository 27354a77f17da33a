#include "tests/fuzz/set_damage.h"

#include <casacore/casa/Arrays/Array.h>
#include <casacore/tables/DataMan/StandardStMan.h>
#include <casacore/tables/Tables/ArrColDesc.h>
#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/ScaColDesc.h>
#include <casacore/tables/Tables/ScalarColumn.h>
#include <casacore/tables/Tables/Table.h>
#include <casacore/tables/Tables/TableColumn.h>

#include <algorithm>
#include <array>
#include <complex>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace misfit::fuzz {
namespace {

namespace fs = std::filesystem;
using casacore::rownr_t, casacore::Table;

/// What is left of the bytes; zeros in the end.
class Bytes {
 public:
  Bytes(const std::uint8_t* bytes, std::size_t count) : next_(bytes), end_(bytes + count) {}
  bool empty() const { return next_ == end_; }
  std::size_t next() { return empty() ? 0 : *next_++; }
  std::size_t below(std::size_t count) { return count == 0 ? 0 : next() % count; }
  template <typename Choices>
  const auto& one_of(const Choices& choices) {
    return choices[below(std::size(choices))];
  }

 private:
  const std::uint8_t* next_;
  const std::uint8_t* end_;
};

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr std::array numbers{
    0.0,  -1.0,  1.0,   2.0,          3.0,           100.0,        1e9,
    -1e9, 1e30,  -1e30, 1e-300,       infinite,      -infinite,    std::numeric_limits<double>::quiet_NaN(),
    0.5,  1e300, 1.4e9, 2147483647.0, -2147483648.0, 4294967295.0, 65536.0};
const std::array<casacore::String, 9> texts{"",     "a\nb", "'\"\\`$(x)", "\xff\xfe", casacore::String(5000, 'x'),
                                            "LSRK", "km",   "../../etc",  "<script>"};

/// The nearest that the type has.
template <typename T>
T value_of(double number) {
  if constexpr (std::is_floating_point_v<T>) return static_cast<T>(number);
  if constexpr (std::is_same_v<T, casacore::Complex>) return {static_cast<float>(number), -1};
  if constexpr (std::is_same_v<T, casacore::DComplex>) return {number, -1};
  if constexpr (std::is_same_v<T, bool>) return number != 0;
  if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
    if (!(number > static_cast<double>(std::numeric_limits<T>::min()))) return std::numeric_limits<T>::min();
    if (!(number < static_cast<double>(std::numeric_limits<T>::max()))) return std::numeric_limits<T>::max();
    return static_cast<T>(number);
  }
}

template <typename T>
T any_value(Bytes& bytes) {
  if constexpr (std::is_same_v<T, casacore::String>)
    return bytes.one_of(texts);
  else
    return value_of<T>(bytes.one_of(numbers));
}

/// Calls `action` with a value of the type of a column.
template <typename Action>
void with_type_of(casacore::DataType type, const Action& action) {
  switch (type) {
    case casacore::TpBool:
      return action(bool());
    case casacore::TpShort:
      return action(casacore::Short());
    case casacore::TpInt:
      return action(int());
    case casacore::TpUInt:
      return action(casacore::uInt());
    case casacore::TpFloat:
      return action(float());
    case casacore::TpDouble:
      return action(double());
    case casacore::TpComplex:
      return action(casacore::Complex());
    case casacore::TpDComplex:
      return action(casacore::DComplex());
    case casacore::TpString:
      return action(casacore::String());
    default:
      return;
  }
}

/// Rows [first, end): one, or all.
struct RowSpan {
  rownr_t first = 0, end = 0;
};

RowSpan some_rows(Bytes& bytes, rownr_t rows) {
  const bool all = bytes.below(2) == 0;
  const rownr_t first = all ? 0 : bytes.below(rows);
  return {first, all ? rows : std::min(rows, first + 1)};
}

void change_values(Table& table, const casacore::ColumnDesc& column, Bytes& bytes) {
  const RowSpan rows = some_rows(bytes, table.nrow());
  with_type_of(column.dataType(), [&](auto sample) {
    using T = decltype(sample);
    const T value = any_value<T>(bytes);
    const bool whole = bytes.below(2) == 0;
    const std::size_t place = bytes.below(256);
    for (rownr_t row = rows.first; row < rows.end; ++row) {
      if (column.isScalar()) {
        casacore::ScalarColumn<T>(table, column.name()).put(row, value);
        continue;
      }
      casacore::ArrayColumn<T> cells(table, column.name());
      if (!cells.isDefined(row)) continue;
      casacore::Array<T> cell = cells(row);
      if (whole)
        cell = value;
      else if (!cell.empty())
        cell.data()[place % cell.size()] = value;
      cells.put(row, cell);
    }
  });
}

casacore::IPosition any_shape(Bytes& bytes) {
  constexpr std::array lengths{0, 1, 2, 3, 4, 7, 100};
  casacore::IPosition shape(static_cast<casacore::uInt>(bytes.below(4)));
  for (casacore::uInt axis = 0; axis < shape.nelements(); ++axis) shape[axis] = bytes.one_of(lengths);
  return shape;
}

void change_shapes(Table& table, const casacore::ColumnDesc& column, Bytes& bytes) {
  if (!column.isArray()) return;
  const RowSpan rows = some_rows(bytes, table.nrow());
  const casacore::IPosition shape = any_shape(bytes);
  with_type_of(column.dataType(), [&](auto sample) {
    using T = decltype(sample);
    casacore::ArrayColumn<T> cells(table, column.name());
    for (rownr_t row = rows.first; row < rows.end; ++row) cells.put(row, casacore::Array<T>(shape, any_value<T>(bytes)));
  });
}

/// A column of that name with another type or dimension, and nothing or something in it.
void change_type(Table& table, const std::string& name, Bytes& bytes) {
  constexpr std::array types{casacore::TpBool,   casacore::TpInt,     casacore::TpFloat,
                             casacore::TpDouble, casacore::TpComplex, casacore::TpString};
  const casacore::DataType type = bytes.one_of(types);
  const std::size_t dimensions = bytes.below(5);
  const bool filled = bytes.below(2) == 0;
  const casacore::IPosition shape = any_shape(bytes);
  table.removeColumn(name);
  with_type_of(type, [&](auto sample) {
    using T = decltype(sample);
    if (dimensions == 0)
      table.addColumn(casacore::ScalarColumnDesc<T>(name), casacore::StandardStMan("Other" + name));
    else
      table.addColumn(casacore::ArrayColumnDesc<T>(name, static_cast<int>(dimensions) - 1),
                      casacore::StandardStMan("Other" + name));
    if (!filled) return;
    for (rownr_t row = 0; row < table.nrow(); ++row)
      if (dimensions == 0)
        casacore::ScalarColumn<T>(table, name).put(row, any_value<T>(bytes));
      else
        casacore::ArrayColumn<T>(table, name).put(row, casacore::Array<T>(shape, any_value<T>(bytes)));
  });
}

/// Of its values, two rows change places.
void change_order(Table& table, const casacore::ColumnDesc& column, Bytes& bytes) {
  if (!column.isScalar() || table.nrow() == 0) return;
  const rownr_t a = bytes.below(table.nrow()), b = bytes.below(table.nrow());
  with_type_of(column.dataType(), [&](auto sample) {
    casacore::ScalarColumn<decltype(sample)> cells(table, column.name());
    const auto before = cells(a);
    cells.put(a, cells(b));
    cells.put(b, before);
  });
}

/// Units and frames lie in keywords of columns, subtables in those of the table.
void change_keyword(casacore::TableRecord& keywords, Bytes& bytes) {
  if (keywords.nfields() == 0) return;
  const auto field = static_cast<casacore::uInt>(bytes.below(keywords.nfields()));
  switch (bytes.below(4)) {
    case 0:
      return keywords.removeField(field);
    case 1: {
      const casacore::String name = keywords.name(field);
      keywords.removeField(field);
      return keywords.define(name, bytes.one_of(texts));
    }
    case 2: {
      const casacore::String name = keywords.name(field);
      keywords.removeField(field);
      return keywords.define(name, any_value<int>(bytes));
    }
    default:
      if (keywords.dataType(field) == casacore::TpRecord) return change_keyword(keywords.rwSubRecord(field), bytes);
      if (keywords.dataType(field) == casacore::TpArrayString)
        return keywords.define(field, casacore::Array<casacore::String>(
                                          casacore::IPosition(1, static_cast<ssize_t>(bytes.below(4))), bytes.one_of(texts)));
  }
}

void change_rows(Table& table, Bytes& bytes) {
  constexpr std::array counts{0, 1, 2, 1000};
  if (bytes.below(2) == 0) {
    table.addRow(static_cast<rownr_t>(bytes.one_of(counts)));
  } else {
    const auto left = static_cast<rownr_t>(bytes.one_of(counts));
    while (table.nrow() > left) table.removeRow(table.nrow() - 1);
  }
}

fs::path any_file(const fs::path& folder, Bytes& bytes) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  if (files.empty()) throw std::runtime_error("no files");
  std::sort(files.begin(), files.end());
  return bytes.one_of(files);
}

/// Four bytes somewhere in a file of a table become others.
void change_bytes(const fs::path& folder, Bytes& bytes) {
  const fs::path file = any_file(folder, bytes);
  const std::array<std::string, 8> numbers_there{std::string("\0\0\0\0", 4), std::string("\0\0\0\1", 4),
                                                 std::string("\1\0\0\0", 4), std::string("\0\0\1\0", 4),
                                                 "\x7f\xff\xff\xff",         "\xff\xff\xff\xff",
                                                 "\xff\xff\xff\x7f",         std::string(4, static_cast<char>(bytes.next()))};
  const std::size_t size = fs::file_size(file), at = bytes.next() << 16 | bytes.next() << 8 | bytes.next();
  if (size < 4) return;
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  stream.seekp(static_cast<std::streamoff>(at % (size - 3)));
  stream << bytes.one_of(numbers_there);
}

/// Files of a table end early, or are no more.
void cut_file(const fs::path& folder, Bytes& bytes) {
  const fs::path file = any_file(folder, bytes);
  const std::size_t part = bytes.below(256);
  if (part == 0)
    fs::remove(file);
  else
    fs::resize_file(file, fs::file_size(file) * part / 256);
}

/// The set, or one of its subtables.
fs::path any_table(const fs::path& set, Bytes& bytes) {
  std::vector<fs::path> tables;
  for (const auto& entry : fs::directory_iterator(set))
    if (entry.is_directory()) tables.push_back(entry.path());
  std::sort(tables.begin(), tables.end());
  return bytes.below(2) == 0 || tables.empty() ? set : bytes.one_of(tables);
}

void damage_table(const fs::path& folder, std::size_t kind, Bytes& bytes) {
  if (kind == 8) return cut_file(folder, bytes);
  Table table(folder.string(), casacore::TableLock(casacore::TableLock::NoLocking), Table::Update);
  if (kind == 0) return change_rows(table, bytes);
  if (kind == 1) return change_keyword(table.rwKeywordSet(), bytes);
  const casacore::Vector<casacore::String> names = table.tableDesc().columnNames();
  if (names.empty()) return;
  const casacore::String name = names[static_cast<ssize_t>(bytes.below(names.size()))];
  const casacore::ColumnDesc column = table.tableDesc()[name];
  if (kind == 2) return table.removeColumn(name);
  if (kind == 3) return change_type(table, name, bytes);
  if (kind == 4) return change_shapes(table, column, bytes);
  if (kind == 5) return change_order(table, column, bytes);
  if (kind == 6) return change_keyword(casacore::TableColumn(table, name).rwKeywordSet(), bytes);
  change_values(table, column, bytes);
}

}  // namespace

void damage(const std::string& set, const std::uint8_t* bytes, std::size_t count) {
  constexpr std::size_t first_of_bytes = 192;
  Bytes left(bytes, count);
  bool opens = true;  // casacore must not open what has other bytes
  while (!left.empty()) try {
      const fs::path folder = any_table(set, left);
      const std::size_t choice = left.next();
      opens = opens && choice < first_of_bytes;
      if (!opens)
        change_bytes(folder, left);
      else if (choice % 10 == 9 && folder != set)
        fs::remove_all(folder);
      else
        damage_table(folder, choice % 10, left);
    } catch (const std::exception&) {  // not with this table
    }
}

}  // namespace misfit::fuzz
