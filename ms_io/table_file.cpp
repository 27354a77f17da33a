#include <casacore/casa/OS/Path.h>
#include <casacore/casa/Utilities/ValType.h>
#include <casacore/tables/Tables/ColumnDesc.h>
#include <casacore/tables/Tables/Table.h>

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
  struct Field {
    DataType type = casacore::TpOther;
    std::vector<Field> fields;  ///< of a record; where there are none, they come with its values
  };

  void read_plain(std::uint64_t version) {
    const std::uint64_t described = in_.object("TableDesc");
    for (int i = 0; i < 3; ++i) in_.skip_text();
    read_record();
    if (described != 1) read_record();
    const std::uint64_t columns = in_.count(4, "columns", 4);
    for (std::uint64_t c = 0; c < columns; ++c) read_description();
    if (version == 1) read_record();
    read_columns();
  }

  void read_reference() {
    const std::uint64_t version = in_.object("RefTable");
    add_table(in_.text());
    in_.object("SimpleOrderedMap");
    in_.skip_text();
    const std::uint64_t names = in_.count(4, "columns", 8);
    in_.number(4);
    for (std::uint64_t i = 0; i < 2 * names; ++i) in_.skip_text();
    if (version > 1) read_array(casacore::TpString);
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
    for (std::uint64_t i = 0; i < tables; ++i) add_table(in_.text());
    in_.block("names of tables");
  }

  void add_table(const std::string& name) { file_.tables.push_back(casacore::Path::addDirectory(name, table_)); }

  void read_record(int depth = 0) {
    const std::string type = in_.object();
    if (type != "TableRecord" && type != "Record") bytes_.fail("keywords in a '" + type + "'", "a record");
    in_.number(4);
    const std::vector<Field> fields = read_fields(depth);
    in_.number(4);
    read_values(fields, depth);
  }

  std::vector<Field> read_fields(int depth) {
    constexpr int deepest = 64;
    if (depth > deepest) bytes_.fail("records in " + std::to_string(depth) + " others", std::to_string(deepest) + " or fewer");
    const std::uint64_t version = in_.object("RecordDesc");
    std::vector<Field> fields(in_.count(4, "keywords", 8));
    for (Field& field : fields) {
      in_.skip_text();
      field.type = type();
      if (field.type == casacore::TpRecord) field.fields = read_fields(depth + 1);
      if (field.type == casacore::TpTable) in_.skip_text();
      if (casacore::isArray(field.type)) check_values(in_.lengths(), casacore::asScalar(field.type));
      if (version > 1) in_.skip_text();
    }
    return fields;
  }

  /// That an array's values can be in what is left of the file; one whose first length is negative may have any shape.
  double check_values(const std::vector<std::int64_t>& shape, DataType type) const {
    if (!shape.empty() && shape.front() < 0) return 0;
    const double values = product(shape, bytes_, "an array");
    if (values * static_cast<double>(bits_of(type)) / 8 > static_cast<double>(in_.left()))
      bytes_.fail("an array of " + shown(values) + " values", "no more than it holds");
    return values;
  }

  void read_values(const std::vector<Field>& fields, int depth) {
    for (const Field& field : fields)
      if (field.type == casacore::TpRecord && field.fields.empty())
        read_record(depth + 1);
      else if (field.type == casacore::TpRecord)
        read_values(field.fields, depth + 1);
      else if (field.type == casacore::TpTable)
        add_table(in_.text());
      else if (casacore::isArray(field.type))
        read_array(casacore::asScalar(field.type));
      else
        read_value(field.type);
  }

  void read_value(DataType type) {
    if (type == casacore::TpString) return in_.skip_text();
    in_.skip((bits_of(type) + 7) / 8);
  }

  void read_array(DataType type) {
    in_.object();
    const std::int64_t version = in_.integer(4);
    std::vector<std::int64_t> shape(in_.count(4, "axes", 4));
    if (version < 3) in_.skip(4 * shape.size());
    for (std::int64_t& length : shape) length = static_cast<std::int64_t>(in_.number(4));
    const double values = check_values(shape, type);
    const std::uint64_t held = in_.number(4);
    if (static_cast<double>(held) != values) throw Malformed();
    if (type != casacore::TpString) return in_.skip((held * bits_of(type) + 7) / 8);
    for (std::uint64_t i = 0; i < held; ++i) in_.skip_text();
  }

  DataType type() {
    const std::uint64_t type = in_.number(4);
    if (type >= casacore::TpNumberOfTypes) bytes_.fail("values of type " + std::to_string(type), "one that casacore has");
    return static_cast<DataType>(type);
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
    column.type = type();
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
    read_record();
    in_.number(4);
    if (kind == Kind::scalar) read_value(column.type);
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
    if (in_.number(4) == 1) read_record();
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

std::uint64_t bits_of(std::uint64_t type) {
  switch (type) {
    case casacore::TpBool:
      return 1;
    case casacore::TpChar:
    case casacore::TpUChar:
      return 8;
    case casacore::TpShort:
    case casacore::TpUShort:
      return 16;
    case casacore::TpDouble:
    case casacore::TpComplex:
    case casacore::TpInt64:
      return 64;
    case casacore::TpDComplex:
      return 128;
    default:
      return 32;
  }
}

TableFile read_table_file(const std::string& path) {
  return TableFileReader(path).read();
}

}  // namespace misfit::ms_io
