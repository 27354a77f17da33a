// Files of tables, any four bytes of which are others: what `table.dat`, the standard and the incremental storage manager and
// their files of arrays tell of is within them, or the table is refused. casacore would look past the end of what it has, take
// gigabytes, or go round in circles.
#include <casacore/tables/DataMan/IncrementalStMan.h>
#include <casacore/tables/DataMan/StandardStMan.h>
#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/ScaColDesc.h>
#include <casacore/tables/Tables/SetupNewTab.h>
#include <casacore/tables/Tables/TableDesc.h>
#include <casacore/tables/Tables/TableRecord.h>

#include <exception>

#include "ms_io/storage_managers_internal.h"
#include "tests/ms_io/damaged_files.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(stored_headers)

using namespace testing;

namespace {

using casacore::rownr_t, casacore::String, casacore::IPosition;

template <typename T>
void read_column(const casacore::Table& table, const std::string& name, bool is_array) {
  if (!is_array) {
    casacore::ScalarColumn<T>(table, name).getColumn();
    return;
  }
  const casacore::ArrayColumn<T> cells(table, name);
  for (rownr_t row = 0; row < table.nrow(); ++row)
    if (cells.isDefined(row)) cells.get(row);
}

void read_column(const casacore::Table& table, const casacore::ColumnDesc& column) {
  switch (column.dataType()) {
    case casacore::TpInt:
      return read_column<int>(table, column.name(), column.isArray());
    case casacore::TpBool:
      return read_column<bool>(table, column.name(), column.isArray());
    case casacore::TpDouble:
      return read_column<double>(table, column.name(), column.isArray());
    case casacore::TpString:
      return read_column<String>(table, column.name(), column.isArray());
    default:
      return;
  }
}

/// All that can be read, also after one that cannot.
void read_columns(const casacore::Table& table) {
  std::exception_ptr refused;
  for (casacore::uInt c = 0; c < table.tableDesc().ncolumn(); ++c) try {
      read_column(table, table.tableDesc()[c]);
    } catch (const std::exception&) {
      refused = std::current_exception();
    }
  if (refused) std::rethrow_exception(refused);
}

void read_table(const std::string& path) {
  check_storage_managers(path);
  read_columns(casacore::Table(path, casacore::TableLock(casacore::TableLock::NoLocking)));
}

casacore::TableDesc description() {
  casacore::TableDesc table;
  table.addColumn(casacore::ScalarColumnDesc<int>("NUMBER"));
  table.addColumn(casacore::ScalarColumnDesc<bool>("FLAG"));
  table.addColumn(casacore::ScalarColumnDesc<String>("NAME"));
  casacore::ScalarColumnDesc<String> code("CODE");
  code.setMaxLength(4);
  table.addColumn(code);
  table.addColumn(casacore::ArrayColumnDesc<double>("PLACE", IPosition(1, 3), casacore::ColumnDesc::Direct));
  table.addColumn(casacore::ArrayColumnDesc<double>("CELLS"));
  table.addColumn(casacore::ArrayColumnDesc<bool>("BITS"));
  table.addColumn(casacore::ArrayColumnDesc<String>("WORDS"));
  table.addColumn(casacore::ArrayColumnDesc<String>("PAIR", IPosition(1, 2), casacore::ColumnDesc::Direct));
  casacore::TableRecord units;
  units.define("UNITS", casacore::Vector<String>(2, "km"));
  units.define("ORDER", 3);
  units.define("NONE", casacore::Array<int>());
  table.rwColumnDesc("CELLS").rwKeywordSet().defineRecord("ABOUT", units);
  table.rwKeywordSet().define("VERSION", 2.0F);
  return table;
}

struct Storage {
  std::string manager;
  casacore::Table::EndianFormat order;
};
std::ostream& operator<<(std::ostream& out, const Storage& storage) {
  return out << storage.manager << " " << storage.order;
}

constexpr rownr_t table_rows = 7;

void make_table(const std::string& path, const Storage& storage) {
  casacore::SetupNewTable setup(path, description(), casacore::Table::New);
  constexpr int bucket = 384;
  if (storage.manager == "StandardStMan")
    setup.bindAll(casacore::StandardStMan("Manager", bucket));
  else
    setup.bindAll(casacore::IncrementalStMan("Manager", bucket, false));
  casacore::Table table(setup, casacore::Table::Plain, table_rows, true, storage.order);
  for (rownr_t row = 0; row < table_rows; ++row) {
    const double value = static_cast<double>(row);
    casacore::ScalarColumn<int>(table, "NUMBER").put(row, static_cast<int>(row));
    casacore::ScalarColumn<bool>(table, "FLAG").put(row, row % 2 == 0);
    casacore::ScalarColumn<String>(table, "NAME").put(row, String(5 * row, 'x'));
    casacore::ScalarColumn<String>(table, "CODE").put(row, "ab");
    casacore::ArrayColumn<double>(table, "PLACE").put(row, casacore::Vector<double>(3, value));
    if (row == 0) casacore::ArrayColumn<double>(table, "CELLS").put(row, casacore::Array<double>());  // without axes
    if (row % 3 != 0) casacore::ArrayColumn<double>(table, "CELLS").put(row, casacore::Matrix<double>(2, row, value));
    casacore::ArrayColumn<bool>(table, "BITS").put(row, casacore::Vector<bool>(row, true));
    if (storage.manager == "StandardStMan" || row % 3 != 0)
      casacore::ArrayColumn<String>(table, "WORDS").put(row, casacore::Vector<String>(row, "word"));
    casacore::ArrayColumn<String>(table, "PAIR").put(row, casacore::Vector<String>(2, String(row, 'y')));
  }
}

const std::vector<Storage> storages{{"StandardStMan", casacore::Table::LittleEndian},
                                    {"IncrementalStMan", casacore::Table::BigEndian}};

void check_file(const std::string& file) {
  for (const Storage& storage : storages) {
    BOOST_TEST_CONTEXT(storage) {
      const TemporaryFolder folder;
      make_table(folder / "a.table", storage);
      check_every_number(folder / "a.table/" + file, [&] { read_table(folder / "a.table"); });
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_table_is_read_or_refused_whatever_its_file_says) {
  check_file("table.dat");
}
BOOST_AUTO_TEST_CASE(whatever_its_columns_say) {
  check_file("table.f0");
}
BOOST_AUTO_TEST_CASE(whatever_its_arrays_say) {
  check_file("table.f0i");
}
BOOST_AUTO_TEST_CASE(whatever_its_lock_file_says) {
  check_file("table.lock");
}

BOOST_AUTO_TEST_CASE(a_table_of_rows_of_another_is_read_or_refused) {
  const TemporaryFolder folder;
  make_table(folder / "a.table", storages.front());
  {
    casacore::Vector<rownr_t> rows(2, table_rows - 1);
    rows[0] = 1;
    casacore::Table(folder / "a.table")(rows).rename(folder / "b.table", casacore::Table::New);
  }
  check_every_number(folder / "b.table/table.dat", [&] { read_table(folder / "b.table"); });
}

BOOST_AUTO_TEST_CASE(a_table_that_refers_to_itself_is_refused) {
  const TemporaryFolder folder;
  make_table(folder / "a.table", storages.front());
  {
    casacore::Vector<rownr_t> rows(1, 1);
    casacore::Table(folder / "a.table")(rows).rename(folder / "b.table", casacore::Table::New);
  }
  replace_bytes(folder / "b.table/table.dat", "/a.table", "/b.table");
  BOOST_CHECK_EXCEPTION(read_table(folder / "b.table"), std::runtime_error, [&](const std::exception& error) {
    return std::string(error.what()).find("b.table: it refers to itself") != std::string::npos;
  });
}

BOOST_AUTO_TEST_CASE(a_keyword_of_a_type_that_no_record_has_is_refused) {
  const TemporaryFolder folder;
  make_table(folder / "a.table", storages.front());
  const std::string name = "ORDER", integer("\0\0\0\5", 4), short_unsigned("\0\0\0\4", 4);
  replace_bytes(folder / "a.table/table.dat", name + integer, name + short_unsigned);
  BOOST_CHECK_EXCEPTION(read_table(folder / "a.table"), std::runtime_error, [&](const std::exception& error) {
    return std::string(error.what()).find("a keyword of type 4") != std::string::npos;
  });
}

BOOST_AUTO_TEST_CASE(tables_that_are_not_read_may_have_been_emptied) {
  const SmallSet set;
  const std::string file = set.path() + "/HISTORY/table.dat";
  casacore::Table(set.path() + "/HISTORY", casacore::Table::Update).addRow(3);
  const std::string before = bytes_of(file);
  {
    casacore::Table history(set.path() + "/HISTORY", casacore::Table::Update);
    history.removeRow(history.rowNumbers());
  }
  put_bytes(file, 0, before);  // which other programs leave as it is
  BOOST_CHECK_THROW(check_storage_managers(set.path() + "/HISTORY"), std::runtime_error);  // which says how many rows it had
  BOOST_TEST(MeasurementSet(set.path(), {}, "DATA").rows() == rows);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
