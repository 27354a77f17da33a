#include <casacore/casa/OS/Path.h>
#include <casacore/casa/Utilities/ValType.h>
#include <casacore/tables/Tables/ColumnDesc.h>
#include <casacore/tables/Tables/Table.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "ms_io/table_file_internal.h"

namespace misfit::ms_io {
namespace {

using casacore::DataType;

/// Reads in the order in which casacore (Table, PlainTable, TableDesc, RecordRep, ColumnSet) does.
class TableFileReader {
 public:
  explicit TableFileReader(const std::string& table) : table_(table), bytes_(casacore::Table::fileName(table)), in_(bytes_) {}

  TableFile read() {
    in_.magic();
    const std::uint64_t version = in_.object("Table");
    file_.rows = in_.number(version > 2 ? 8 : 4);
    file_.order = in_.number(4) == 0 ? ByteOrder::big : ByteOrder::little;
    const std::string kind = in_.text();
    if (kind == "PlainTable") read_plain(version);
    if (kind == "RefTable") read_reference();
    if (kind == "ConcatTable") read_concatenation();
    return std::move(file_);
  }

 private:
  void read_plain(std::uint64_t version) {
    const std::uint64_t described = in_.object("TableDesc");
    for (int i = 0; i < 3; ++i) in_.skip_text();
    read_keywords();
    if (described != 1) read_keywords();
    const std::uint64_t columns = in_.count(4, "columns", 4);
    for (std::uint64_t c = 0; c < columns; ++c) read_description();
    if (version == 1) read_keywords();
    read_columns();
  }

  void read_reference() {
    const std::uint64_t version = in_.object("RefTable");
    file_.references.push_back(path_of(in_.text()));
    in_.object("SimpleOrderedMap");
    in_.skip_text();
    const std::uint64_t names = in_.count(4, "columns", 8);
    in_.number(4);
    for (std::uint64_t i = 0; i < 2 * names; ++i) in_.skip_text();
    if (version > 1) skip_array(in_, casacore::TpString);
    const std::size_t size = version > 2 ? 8 : 4;
    const std::uint64_t referred = in_.number(size);
    in_.number(1);
    const std::uint64_t rows = in_.count(size, "rows", size);
    if (rows != file_.rows)
      bytes_.fail(std::to_string(file_.rows) + " rows", "the " + std::to_string(rows) + " to which it refers");
    for (std::uint64_t r = 0; r < rows; ++r)
      if (const std::uint64_t row = in_.number(size); row >= referred)
        bytes_.fail("row " + std::to_string(row) + " of another table", "one of the " + std::to_string(referred) + " that has");
  }

  void read_concatenation() {
    in_.object("ConcatTable");
    const std::uint64_t tables = in_.count(4, "tables", 4);
    for (std::uint64_t i = 0; i < tables; ++i) file_.references.push_back(path_of(in_.text()));
    in_.block("names of tables");
  }

  std::string path_of(const std::string& table) const { return casacore::Path::addDirectory(table, table_); }

  void read_keywords() {
    for (const std::string& name : read_record(in_)) file_.subtables.push_back(path_of(name));
  }

  enum class Kind { scalar, array, record };

  Kind kind_of(const std::string& name, const std::string& of, DataType type) const {
    if (name == "ScalarRecordColumnDesc") return Kind::record;
    const std::string values = "ColumnDesc<" + casacore::ValType::getTypeStr(type);
    if (has_columns_of(type) && name == "Scalar" + values) return Kind::scalar;
    if (has_columns_of(type) && name == "Array" + values) return Kind::array;
    bytes_.fail("a column " + of + " of kind '" + name + "'", "one that casacore has for its values");
  }
  static bool has_columns_of(DataType type) {
    return (type <= casacore::TpString && type != casacore::TpChar) || type == casacore::TpInt64;
  }

  void read_description() {
    in_.number(4);
    const std::string name = in_.text();
    in_.number(4);
    StoredColumn column;
    column.name = in_.text();
    for (int i = 0; i < 3; ++i) in_.skip_text();
    column.type = read_type(in_);
    const Kind kind = kind_of(name, column.name, column.type);
    column.is_array = kind != Kind::scalar;
    const std::uint64_t options = in_.number(4);
    column.has_shape = kind == Kind::array && (options & casacore::ColumnDesc::FixedShape) != 0;
    column.in_place = kind == Kind::scalar || (kind == Kind::array && (options & casacore::ColumnDesc::Direct) != 0);
    if (kind == Kind::array && column.in_place && !column.has_shape)
      bytes_.fail("cells of " + column.name + " in place without a shape", "one");
    in_.number(4);
    if (kind == Kind::array) in_.lengths();
    column.longest_text = in_.number(4);
    read_keywords();
    in_.number(4);
    if (kind == Kind::scalar) skip_value(in_, column.type);
    if (kind == Kind::array) in_.number(1);
    if (kind == Kind::record) column.type = casacore::TpUChar;  // as whose array casacore stores it
    kinds_.push_back(kind);
    file_.columns.push_back(column);
  }

  void read_columns() {
    const std::int64_t version = -in_.integer(4);
    if (version > 0) in_.number(version > 2 ? 8 : 4);
    if (version > 2) in_.skip(8);
    in_.number(4);
    file_.managers.resize(in_.count(4, "storage managers", 8));
    for (StorageManager& manager : file_.managers) {
      manager.type = in_.text();
      manager.number = in_.number(4);
    }
    if (version <= 0)
      bytes_.fail("columns in the order of their names", "a version of such a list, which every MeasurementSet has");
    for (std::size_t c = 0; c < file_.columns.size(); ++c) read_column(file_.columns[c], kinds_[c]);
    for (StorageManager& manager : file_.managers) {
      const std::uint64_t length = in_.count(4, "bytes", 1);
      manager.kept = bytes_.read(in_.at(), length);
      in_.skip(length);
    }
  }

  void read_column(StoredColumn& column, Kind kind) {
    if (in_.number(4) == 1) read_keywords();
    in_.skip_text();
    in_.number(4);
    column.manager = in_.number(4);
    if (kind != Kind::array || in_.number(1) == 0) return;
    const std::vector<std::int64_t> shape = in_.lengths();
    if (column.has_shape) column.shape = shape;
  }

  TableFile file_;
  std::vector<Kind> kinds_;
  std::string table_;
  StoredBytes bytes_;
  ObjectReader in_;
};

}  // namespace

TableFile read_table_file(const std::string& path) {
  return TableFileReader(path).read();
}

std::vector<StoredColumn> columns_of(const TableFile& table, const StorageManager& manager) {
  std::vector<StoredColumn> columns;
  std::copy_if(table.columns.begin(), table.columns.end(), std::back_inserter(columns),
               [&](const StoredColumn& column) { return column.manager == manager.number; });
  return columns;
}

std::string file_of(const std::string& path, const StorageManager& manager) {
  return path + "/table.f" + std::to_string(manager.number);
}

}  // namespace misfit::ms_io
