// Where a model column can be written, and how one is stored that is made.
#include <casacore/tables/DataMan/IncrementalStMan.h>
#include <casacore/tables/DataMan/StandardStMan.h>
#include <casacore/tables/DataMan/TiledShapeStMan.h>
#include <casacore/tables/Tables/ScaColDesc.h>
#include <sys/wait.h>

#include <boost/test/unit_test.hpp>

#include "ms_io/model_writer.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(model_storage)

using namespace testing;

namespace {

using casacore::Complex;

ModelWriteReport write(const std::string& path, const std::string& column = "MODEL_DATA", const Selection& selection = {}) {
  return write_model(path, selection, {column}, small_visibilities, {});
}

Complex expected_at(std::size_t row, std::size_t channel) {
  return {static_cast<float>(row + 1), 1000 + static_cast<float>(channel)};
}

/// DATA under another name or type.
template <typename T>
void store_data_as(const SmallSet& set, const std::string& column) {
  set.modify([&](casacore::MeasurementSet& ms) {
    ms.addColumn(casacore::ArrayColumnDesc<T>(column, casacore::IPosition(2, 2, channels), casacore::ColumnDesc::FixedShape));
    casacore::ArrayColumn<T>(ms, column).fillColumn(casacore::Matrix<T>(2, channels, T(1)));
    ms.removeColumn("DATA");
  });
}

/// Every second row, saved as a table of its own that refers to them.
std::string odd_rows(const SmallSet& set) {
  casacore::MeasurementSet ms(set.path());
  casacore::Vector<casacore::rownr_t> odd(rows / 2);
  for (std::size_t r = 0; r < rows / 2; ++r) odd(r) = 2 * r + 1;
  const std::string path = set.path() + ".odd";
  ms(casacore::RowNumbers(odd)).rename(path, casacore::Table::New);
  return path;
}

/// The type of the manager that stores a column.
std::string storage(const SmallSet& set, const casacore::String& column) {
  const casacore::Record managers = casacore::MeasurementSet(set.path()).dataManagerInfo();
  for (casacore::uInt i = 0; i < managers.nfields(); ++i) {
    const casacore::Record manager = managers.asRecord(i);
    for (const casacore::String& name : manager.asArrayString("COLUMNS"))
      if (name == column) return manager.asString("TYPE");
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_new_column_is_plain_where_the_data_are_compressed) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& ms) {
    casacore::Record specification;
    specification.define("dataBitCount", 10);
    specification.define("weightBitCount", 12);
    specification.define("distribution", "TruncatedGaussian");
    specification.define("distributionTruncation", 1.5);
    specification.define("normalization", "RF");
    specification.define("studentTNu", 0.0);
    casacore::DataManagerCtor dysco = casacore::DataManager::getCtor("DyscoStMan");
    const casacore::CountedPtr<casacore::DataManager> manager(dysco("DyscoData", specification));
    const casacore::Array<Complex> data = casacore::ArrayColumn<Complex>(ms, "DATA").getColumn();
    ms.removeColumn("DATA");
    ms.addColumn(casacore::ArrayColumnDesc<Complex>("DATA", casacore::IPosition(2, 2, channels),
                                                    casacore::ColumnDesc::FixedShape | casacore::ColumnDesc::Direct),
                 *manager);
    casacore::ArrayColumn<Complex>(ms, "DATA").putColumn(data);
  });
  write(set.path());
  BOOST_TEST(storage(set, "DATA") == "DyscoStMan");
  BOOST_TEST(storage(set, "MODEL_DATA") == "TiledColumnStMan");
  BOOST_TEST(set.cell("MODEL_DATA", 7)(1, 3) == expected_at(7, 3));
  set.modify([](casacore::MeasurementSet& ms) { ms.renameColumn("MINE", "DATA"); });
  BOOST_TEST(contains(error_of([&] { write(set.path(), "MINE"); }), "stored by DyscoStMan, which rounds"));
}

BOOST_AUTO_TEST_CASE(no_data_column_is_needed) {
  const SmallSet corrected, real;
  store_data_as<Complex>(corrected, "CORRECTED_DATA");
  store_data_as<float>(real, "FLOAT_DATA");
  for (const SmallSet* set : {&corrected, &real}) {
    write(set->path());
    BOOST_TEST(set->cell("MODEL_DATA", 7)(1, 3) == expected_at(7, 3));
    BOOST_TEST(MeasurementSet(set->path(), {}, "").samples() == rows * channels);
  }
}

BOOST_AUTO_TEST_CASE(a_column_of_another_type_is_named_with_it) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& ms) {
    ms.addColumn(casacore::ArrayColumnDesc<casacore::DComplex>("DOUBLE", 2));
    ms.addColumn(casacore::ArrayColumnDesc<float>("REAL", 2));
    ms.addColumn(casacore::ScalarColumnDesc<Complex>("SINGLE"));
  });
  for (const auto& [column, type] : std::map<std::string, std::string>{
           {"DOUBLE", "arrays of type DComplex"}, {"REAL", "arrays of type float"}, {"SINGLE", "single values"}}) {
    const std::string error = error_of([&, to = column] { write(set.path(), to); });
    BOOST_TEST_INFO(error);
    BOOST_TEST(contains(error, "column " + column + " of " + set.path() + " holds " + type));
  }
}

BOOST_AUTO_TEST_CASE(other_storage_is_written_as_it_stands) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& ms) {
    ms.addColumn(casacore::ArrayColumnDesc<Complex>("PLAIN", casacore::IPosition(2, 2, channels), casacore::ColumnDesc::Direct),
                 casacore::StandardStMan("PlainStMan"));
  });
  write(set.path(), "PLAIN");
  for (std::size_t r = 0; r < rows; ++r) BOOST_TEST(set.cell("PLAIN", r)(0, 5) == expected_at(r, 5));
}

BOOST_AUTO_TEST_CASE(storage_that_a_killed_run_would_spoil_is_refused) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& ms) {
    ms.addColumn(casacore::ArrayColumnDesc<Complex>("SHARED", 2), casacore::IncrementalStMan("SharedStMan"));
  });
  BOOST_TEST(contains(error_of([&] { write(set.path(), "SHARED"); }), "is stored by IncrementalStMan, whose index changes"));
}

BOOST_AUTO_TEST_CASE(rows_that_a_table_refers_to_are_written_and_no_others_of_theirs) {
  const SmallSet set;
  const std::string odd = odd_rows(set);
  const std::string refused = error_of([&] { write(odd); });
  BOOST_TEST_INFO(refused);
  BOOST_TEST(contains(refused, odd + " has no column MODEL_DATA and refers to the rows of "));
  BOOST_TEST(!casacore::MeasurementSet(set.path()).tableDesc().isColumn("MODEL_DATA"));
  const auto sevens = [](const imager::SampleCoordinates& where) {
    return std::vector<std::complex<double>>(where.samples(), 7.0);
  };
  write_model(set.path(), {}, {"MODEL_DATA"}, sevens, {});
  const std::string with_model = odd_rows(set);
  int blocks = 0;
  const auto stop = [&](std::uint64_t, std::uint64_t) {
    if (++blocks == 2) throw std::runtime_error("stop");
  };
  BOOST_CHECK_THROW(write_model(with_model, {}, {"MODEL_DATA"}, small_visibilities, stop, {2 * channels}), std::runtime_error);
  for (const std::string& path : {with_model, set.path()})
    BOOST_TEST(contains(incomplete_column(path, "model"), "4 of 15 rows"));
  write(with_model);
  for (std::size_t r = 0; r < rows; ++r) {
    BOOST_TEST(set.cell("MODEL_DATA", r)(0, 2) == (r % 2 == 1 ? expected_at(r, 2) : Complex(7)));
  }
  BOOST_TEST(incomplete_column(set.path(), "model") == "");
}

BOOST_AUTO_TEST_CASE(cells_without_a_shape_are_given_one_where_a_table_refers_to_them) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& ms) {
    ms.addColumn(casacore::ArrayColumnDesc<Complex>("MINE", 2),
                 casacore::TiledShapeStMan("Mine", casacore::IPosition(3, 2, channels, 7)));
    casacore::ArrayColumn<Complex>(ms, "MINE").put(2, casacore::Matrix<Complex>(2, channels, Complex(7)));
  });
  write(odd_rows(set), "MINE");
  for (std::size_t r = 0; r < rows; ++r) {
    BOOST_TEST(set.cell("MINE", r)(0, 2) == (r % 2 == 1 ? expected_at(r, 2) : Complex(r == 2 ? 7 : 0)));
  }
}

BOOST_AUTO_TEST_CASE(a_set_that_another_process_keeps_locked_is_named) {
  const SmallSet set;
  int ready[2];
  BOOST_REQUIRE(pipe(ready) == 0);
  const pid_t child = fork();
  if (child == 0) {
    const casacore::MeasurementSet held(set.path(), casacore::TableLock(casacore::TableLock::PermanentLocking),
                                        casacore::Table::Update);
    if (::write(ready[1], "x", 1) != 1) _exit(1);
    pause();
  }
  char byte = 0;
  BOOST_REQUIRE(::read(ready[0], &byte, 1) == 1);
  const std::string error = error_of([&] { write(set.path()); });
  BOOST_TEST(read_all(MeasurementSet(set.path(), {}, "DATA")).counts.rows_read == rows);  // which needs no lock
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  BOOST_TEST(contains(error, set.path() + " is locked by another process"));
  write(set.path());
  BOOST_TEST(set.cell("MODEL_DATA", 7)(1, 3) == expected_at(7, 3));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
