#include "ms_io/stored_records_internal.h"

namespace misfit::ms_io {
namespace {

using casacore::DataType;

/// Reads in the order in which casacore (RecordRep, RecordDesc) does.
class RecordReader {
 public:
  explicit RecordReader(ObjectReader& in) : in_(in) {}

  void read(int depth = 0) {
    const std::string type = in_.object();
    if (type != "TableRecord" && type != "Record") in_.bytes().fail("keywords in a '" + type + "'", "a record");
    in_.number(4);
    const std::vector<Field> fields = read_fields(depth);
    in_.number(4);
    read_values(fields, depth);
  }

  std::vector<std::string> tables;

 private:
  struct Field {
    std::string name;
    DataType type = casacore::TpOther;
    std::vector<Field> fields;  ///< of a record; where there are none, they come with its values
  };

  static bool has_values_of(DataType type) {
    return type <= casacore::TpString && type != casacore::TpChar && type != casacore::TpUShort;
  }
  static bool is_whole(DataType type) {
    return type == casacore::TpInt || type == casacore::TpUInt || type == casacore::TpInt64;
  }
  DataType read_field_type() {
    const DataType type = read_type(in_);
    const bool holds = type == casacore::TpRecord || type == casacore::TpTable || type == casacore::TpInt64 ||
                       type == casacore::TpArrayInt64 || has_values_of(type) ||
                       (type <= casacore::TpArrayString && casacore::isArray(type) && has_values_of(casacore::asScalar(type)));
    if (!holds) in_.bytes().fail("a keyword of type " + std::to_string(type), "one that casacore has for it");
    return type;
  }

  std::vector<Field> read_fields(int depth) {
    constexpr int deepest = 64;
    if (depth > deepest)
      in_.bytes().fail("records in " + std::to_string(depth) + " others", std::to_string(deepest) + " or fewer");
    const std::uint64_t version = in_.object("RecordDesc");
    std::vector<Field> fields(in_.count(4, "keywords", 8));
    for (Field& field : fields) {
      field.name = in_.text();
      field.type = read_field_type();
      if (field.type == casacore::TpRecord) field.fields = read_fields(depth + 1);
      if (field.type == casacore::TpTable) in_.skip_text();
      if (casacore::isArray(field.type)) read_shape(casacore::asScalar(field.type));
      if (version > 1) in_.skip_text();
    }
    return fields;
  }

  /// Reads a shape. A shape whose first length is negative stands for any.
  void read_shape(DataType type) {
    const std::vector<std::int64_t> shape = in_.lengths();
    if (!shape.empty() && shape.front() >= 0) check_values(in_, shape, type);
  }

  void read_values(const std::vector<Field>& fields, int depth) {
    for (const Field& field : fields)
      if (field.type == casacore::TpRecord && field.fields.empty())
        read(depth + 1);
      else if (field.type == casacore::TpRecord)
        read_values(field.fields, depth + 1);
      else if (field.name == "ndim" && is_whole(field.type))
        read_axes(bits_of(field.type) / 8);
      else if (field.type == casacore::TpTable)
        tables.push_back(in_.text());
      else if (casacore::isArray(field.type))
        skip_array(in_, casacore::asScalar(field.type));
      else
        skip_value(in_, field.type);
  }

  /// Reads the axes of a hypercolumn, for each of which casacore takes memory.
  void read_axes(std::size_t size) {
    constexpr std::uint64_t most = 1 << 16;
    if (const std::uint64_t axes = in_.number(size); axes > most)
      in_.bytes().fail("ndim of " + std::to_string(axes), std::to_string(most) + " or less");
  }

  ObjectReader& in_;
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

DataType read_type(ObjectReader& in) {
  const std::uint64_t type = in.number(4);
  if (type >= casacore::TpNumberOfTypes) in.bytes().fail("values of type " + std::to_string(type), "one that casacore has");
  return static_cast<DataType>(type);
}

double check_values(const ObjectReader& in, const std::vector<std::int64_t>& shape, DataType type) {
  const double values = product(shape, in.bytes(), "an array");
  if (values * static_cast<double>(bits_of(type)) / 8 > static_cast<double>(in.left()))
    in.bytes().fail("an array of " + shown(values) + " values", "no more than it holds");
  return values;
}

void skip_value(ObjectReader& in, DataType type) {
  if (type == casacore::TpString) return in.skip_text();
  in.skip((bits_of(type) + 7) / 8);
}

void skip_array(ObjectReader& in, DataType type) {
  in.object();
  const std::int64_t version = in.integer(4);
  std::vector<std::int64_t> shape(in.count(4, "axes", 4));
  if (version < 3) in.skip(4 * shape.size());
  for (std::int64_t& length : shape) length = static_cast<std::int64_t>(in.number(4));
  const double values = check_values(in, shape, type);
  const std::uint64_t held = in.number(4);
  if (static_cast<double>(held) != values) throw Malformed{in.bytes().path()};
  if (type != casacore::TpString) return in.skip((held * bits_of(type) + 7) / 8);
  for (std::uint64_t i = 0; i < held; ++i) in.skip_text();
}

std::vector<std::string> read_record(ObjectReader& in) {
  RecordReader reader(in);
  reader.read();
  return reader.tables;
}

}  // namespace misfit::ms_io
