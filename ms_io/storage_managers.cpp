#include <casacore/casa/IO/AipsIO.h>
#include <casacore/casa/OS/Path.h>
#include <casacore/tables/Tables/TableAttr.h>
#include <casacore/tables/Tables/TableDesc.h>
#include <casacore/tables/Tables/TableRecord.h>

#include <filesystem>
#include <set>
#include <stdexcept>
#include <vector>

#include "ms_io/storage_managers_internal.h"
#include "ms_io/table_access_internal.h"
#include "ms_io/tiled_headers_internal.h"

namespace misfit::ms_io {
namespace {

namespace fs = std::filesystem;
using casacore::uInt;

/// What a table holds beside its rows, read in the order in which casacore (Table, PlainTable, ColumnSet) does.
class TableFile {
 public:
  explicit TableFile(const std::string& table) : table_(table), file_(casacore::Table::fileName(table)) {
    const uInt version = file_.getstart("Table");
    skip_rows(version > 2);
    number();  // the order of its bytes
    const std::string kind = text();
    if (kind == "PlainTable") read_plain();
    if (kind == "RefTable") read_reference(1);
    if (kind == "ConcatTable") read_reference(0);
  }

  struct Manager {
    std::string type;
    uInt number;  ///< in the names of its files
  };
  const std::vector<Manager>& managers() const { return managers_; }
  /// Tables that it refers to, or holds.
  const std::vector<std::string>& tables() const { return tables_; }

 private:
  uInt number() {
    uInt number = 0;
    file_ >> number;
    return number;
  }
  std::string text() {
    casacore::String text;
    file_ >> text;
    return text;
  }
  void skip_rows(bool wide) {
    casacore::uInt64 rows = 0;
    if (wide)
      file_ >> rows;
    else
      number();
  }

  void read_plain() {
    casacore::TableDesc description;
    description.getFile(file_, casacore::TableAttr(table_));
    add_tables(description.keywordSet());
    for (uInt c = 0; c < description.ncolumn(); ++c) add_tables(description[c].keywordSet());
    int version = 0;
    file_ >> version;
    if (version < 0) skip_rows(-version > 2);
    if (-version >= 3) {
      number();
      number();
    }
    number();
    const uInt count = number();
    for (uInt i = 0; i < count; ++i) {
      managers_.push_back({text(), number()});
    }
  }

  void read_reference(uInt tables) {
    file_.getstart(tables == 0 ? "ConcatTable" : "RefTable");
    if (tables == 0) tables = number();
    for (uInt i = 0; i < tables; ++i) tables_.push_back(casacore::Path::addDirectory(text(), table_));
  }

  void add_tables(const casacore::TableRecord& keywords) {
    for (uInt field = 0; field < keywords.nfields(); ++field) {
      if (keywords.dataType(field) == casacore::TpTable) tables_.push_back(keywords.tableAttributes(field).name());
      if (keywords.dataType(field) == casacore::TpRecord) add_tables(keywords.subRecord(field));
    }
  }

  std::string table_;
  casacore::AipsIO file_;
  std::vector<Manager> managers_;
  std::vector<std::string> tables_;
};

/// casacore would wait for somebody to write into a pipe.
void check_files(const std::string& table) {
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(table, none))
    if (entry.path().filename().string().rfind("table.", 0) == 0 && entry.exists(none) && !entry.is_regular_file(none))
      throw std::runtime_error("cannot read " + entry.path().string() + ": it is no regular file");
}

void check(const std::string& path, std::set<std::string>& checked) {
  if (!checked.insert(path).second) return;
  check_files(path);
  try {
    const TableFile table(path);
    for (const TableFile::Manager& manager : table.managers()) {
      if (manager.type.find('/') != std::string::npos)
        throw std::runtime_error(path + " has columns stored by '" + manager.type +
                                 "', expected the name of a storage manager, not a path");
      if (manager.type.rfind("Tiled", 0) == 0) check_tiled_header(path + "/table.f" + std::to_string(manager.number));
    }
    for (const std::string& other : table.tables()) check(other, checked);
  } catch (const casacore::AipsError&) {  // casacore will say why
  }
}

}  // namespace

void check_storage_managers(const std::string& path) {
  std::set<std::string> checked;
  check(casacore::Path(path).absoluteName(), checked);
}

}  // namespace misfit::ms_io
