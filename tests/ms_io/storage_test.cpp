// The same samples, stored in other ways.
#include <casacore/tables/DataMan/IncrementalStMan.h>
#include <casacore/tables/DataMan/StManAipsIO.h>
#include <casacore/tables/DataMan/StandardStMan.h>
#include <casacore/tables/DataMan/TiledCellStMan.h>
#include <casacore/tables/DataMan/TiledColumnStMan.h>
#include <casacore/tables/DataMan/TiledShapeStMan.h>
#include <casacore/tables/TaQL/TableParse.h>

#include <boost/test/unit_test.hpp>
#include <map>
#include <memory>

#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(storage)

using namespace testing;

namespace {

AllSamples read_path(const std::string& path, const Selection& selection = {}) {
  return read_all(MeasurementSet(path, selection, "DATA"));
}

void check_same(const AllSamples& is, const AllSamples& should) {
  BOOST_TEST(is.counts.rows_read == should.counts.rows_read);
  BOOST_TEST(is.counts.used == should.counts.used);
  BOOST_TEST(is.counts.flagged == should.counts.flagged);
  BOOST_TEST((is.uvw_m == should.uvw_m));
  BOOST_TEST((is.frequency_hz == should.frequency_hz));
  BOOST_TEST((is.visibility == should.visibility));
  BOOST_TEST((is.weight == should.weight));
}

using Managers = std::map<std::string, std::function<std::unique_ptr<casacore::DataManager>(const std::string&)>>;

/// Those that store arrays of any shape, by name; each for the column named.
const Managers managers = {
    {"StandardStMan", [](const auto& name) { return std::make_unique<casacore::StandardStMan>(name); }},
    {"IncrementalStMan", [](const auto& name) { return std::make_unique<casacore::IncrementalStMan>(name); }},
    {"StManAipsIO", [](const auto& name) { return std::make_unique<casacore::StManAipsIO>(name); }},
    {"TiledColumnStMan",
     [](const auto& name) { return std::make_unique<casacore::TiledColumnStMan>(name, casacore::IPosition(3, 2, 4, 7)); }},
    {"TiledShapeStMan",
     [](const auto& name) { return std::make_unique<casacore::TiledShapeStMan>(name, casacore::IPosition(3, 1, 5, 8)); }},
    {"TiledCellStMan",
     [](const auto& name) { return std::make_unique<casacore::TiledCellStMan>(name, casacore::IPosition(2, 2, 2)); }},
};

/// Stores the cells of `column` anew: by `manager`, of one shape or of any.
template <typename T>
void restore(casacore::MeasurementSet& set, const std::string& column, const casacore::DataManager& manager, bool fixed) {
  const casacore::Array<T> cells = casacore::ArrayColumn<T>(set, column).getColumn();
  const casacore::IPosition cell = cells.shape().getFirst(cells.ndim() - 1);
  set.removeColumn(column);
  casacore::TableDesc description;
  if (fixed) {
    description.addColumn(
        casacore::ArrayColumnDesc<T>(column, cell, casacore::ColumnDesc::FixedShape | casacore::ColumnDesc::Direct));
  } else {
    description.addColumn(casacore::ArrayColumnDesc<T>(column, static_cast<int>(cell.nelements())));
  }
  const auto axes = static_cast<casacore::uInt>(cell.nelements() + (manager.dataManagerType() == "TiledCellStMan" ? 0 : 1));
  description.defineHypercolumn(manager.dataManagerName(), axes, casacore::Vector<casacore::String>(1, column));
  set.addColumn(description, manager);
  casacore::ArrayColumn<T>(set, column).putColumn(cells);
}

/// Stores `column` anew, of every third row no more than channels 2 and 3.
template <typename T>
void keep_channels(casacore::MeasurementSet& set, const std::string& column, const casacore::DataManager& manager) {
  casacore::ArrayColumn<T> cells(set, column);
  std::vector<casacore::Array<T>> kept;
  const casacore::Slicer part(casacore::IPosition(2, 0, 2), casacore::IPosition(2, 2, 2));
  for (casacore::rownr_t row = 0; row < rows; ++row) kept.push_back(row % 3 == 2 ? cells.getSlice(row, part) : cells(row));
  set.removeColumn(column);
  casacore::TableDesc description;
  description.addColumn(casacore::ArrayColumnDesc<T>(column, 2));
  description.defineHypercolumn(manager.dataManagerName(), 3, casacore::Vector<casacore::String>(1, column));
  set.addColumn(description, manager);
  cells.attach(set, column);
  for (casacore::rownr_t row = 0; row < rows; ++row) cells.put(row, kept[row]);
}

/// A sample flagged in each of the ways, and weights that differ.
void mark(const SmallSet& set) {
  set.put("FLAG", 3, 1, 2, true);
  set.put("FLAG_ROW", 4, true);
  set.put("WEIGHT", 5, 1, 0, 3.0F);
}

/// Names, sizes and times of all files.
std::vector<std::string> state_of(const std::string& folder) {
  std::vector<std::string> state;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const bool file = entry.is_regular_file();
    state.push_back(entry.path().string() + " " + std::to_string(file ? entry.file_size() : 0) + " " +
                    std::to_string(entry.last_write_time().time_since_epoch().count()));
  }
  std::sort(state.begin(), state.end());
  return state;
}

}  // namespace

BOOST_AUTO_TEST_CASE(any_storage_manager_gives_the_same_samples) {
  const SmallSet plain;
  mark(plain);
  const AllSamples expected = read_path(plain.path()), part = read_path(plain.path(), {"", "0:1;4"});
  for (const auto& [type, make] : managers)
    for (const bool fixed : {true, false}) {
      if (fixed ? type == "TiledShapeStMan" || type == "TiledCellStMan" : type == "TiledColumnStMan") continue;
      BOOST_TEST_CONTEXT(type << (fixed ? " of one shape" : " of any shape")) {
        const SmallSet set;
        mark(set);
        set.modify([&, &make = make](casacore::MeasurementSet& ms) {
          restore<casacore::Complex>(ms, "DATA", *make("NewData"), fixed);
          restore<bool>(ms, "FLAG", *make("NewFlag"), fixed);
        });
        check_same(read_path(set.path()), expected);
        check_same(read_path(set.path(), {"", "0:1;4"}), part);
      }
    }
}

BOOST_AUTO_TEST_CASE(compressed_data_are_what_casacore_makes_of_them) {
  const SmallSet compressed, plain;
  casacore::Array<casacore::Complex> cells;
  compressed.modify([&](casacore::MeasurementSet& set) {
    casacore::Record specification;
    specification.define("distribution", "TruncatedGaussian");
    specification.define("normalization", "AF");
    specification.define("studentTNu", 0.0);
    specification.define("distributionTruncation", 2.5);
    specification.define("dataBitCount", 10);
    specification.define("weightBitCount", 12);
    const std::unique_ptr<casacore::DataManager> dysco(casacore::DataManager::getCtor("DyscoStMan")("Dysco", specification));
    restore<casacore::Complex>(set, "DATA", *dysco, true);
  });
  {
    const casacore::MeasurementSet set(compressed.path());
    cells = casacore::ArrayColumn<casacore::Complex>(set, "DATA").getColumn();
  }
  plain.modify([&](casacore::MeasurementSet& set) { casacore::ArrayColumn<casacore::Complex>(set, "DATA").putColumn(cells); });
  check_same(read_path(compressed.path()), read_path(plain.path()));
}

BOOST_AUTO_TEST_CASE(cells_may_differ_in_shape_between_data_description_ids) {
  const SmallSet whole, set;
  whole.add_spectral_window();
  set.add_spectral_window();
  set.modify([](casacore::MeasurementSet& ms) {  // the second window loses all but channels 2 and 3
    keep_channels<casacore::Complex>(ms, "DATA", casacore::TiledShapeStMan("NewData", casacore::IPosition(3, 2, 6, 4)));
    keep_channels<bool>(ms, "FLAG", casacore::StandardStMan("NewFlag"));
    casacore::MSSpWindowColumns windows(ms.spectralWindow());
    windows.numChan().put(1, 2);
    for (casacore::ArrayColumn<double>* column :
         {&windows.chanFreq(), &windows.chanWidth(), &windows.effectiveBW(), &windows.resolution()}) {
      column->put(
          1, casacore::Vector<double>((*column)(1)(casacore::Slicer(casacore::IPosition(1, 2), casacore::IPosition(1, 2)))));
    }
  });
  check_same(read_path(set.path()), read_path(whole.path(), {"", "0,1:2~3"}));
}

BOOST_AUTO_TEST_CASE(reference_tables_are_read_as_the_rows_they_refer_to) {
  const SmallSet set;
  set.add_field(1.25, -0.5);
  mark(set);
  const TemporaryFolder folder;
  const std::string path = folder / "some.ms";
  casacore::tableCommand("select from '" + set.path() + "' where FIELD_ID == 1 giving '" + path + "'");
  check_same(read_path(path), read_path(set.path(), {"1", ""}));
  // Selections count the rows of the table that was opened, not of the one where they are stored.
  Selection near;
  near.uv_range = "<30m";
  Selection near_of_field = near;
  near_of_field.field = "1";
  check_same(read_path(path, near), read_path(set.path(), near_of_field));
  casacore::tableCommand("select from '" + set.path() + "' orderby UVW[1] desc giving '" + (folder / "back.ms") + "'");
  AllSamples back = read_path(folder / "back.ms");
  BOOST_TEST(back.counts.used == read_path(set.path()).counts.used);
  BOOST_TEST(back.uvw_m.front() == static_cast<double>(rows));
  BOOST_TEST(back.visibility.front() == std::complex<float>(static_cast<float>(rows), 1000));
}

BOOST_AUTO_TEST_CASE(concatenated_tables_are_read_one_after_the_other) {
  const SmallSet first, second;
  mark(first);
  for (std::size_t row = 0; row < rows; ++row) second.put("UVW", row, 0, 0, 100 + static_cast<double>(row));
  const TemporaryFolder folder;
  const std::string path = folder / "both.ms";
  {
    casacore::Block<casacore::String> names(2);
    names[0] = first.path();
    names[1] = second.path();
    casacore::Table both(names, casacore::Block<casacore::String>());
    both.rename(path, casacore::Table::New);
  }
  const MeasurementSet apart(std::vector<std::string>{first.path(), second.path()}, {}, "DATA");
  const AllSamples expected = read_all(apart), all = read_path(path);
  BOOST_TEST((all.uvw_m == expected.uvw_m));
  BOOST_TEST((all.visibility == expected.visibility));
  BOOST_TEST((all.weight == expected.weight));
  BOOST_TEST(all.counts.used == expected.counts.used);
  Selection far;
  far.uv_range = ">95m";
  BOOST_TEST(read_path(path, far).counts.rows_read == rows);
}

BOOST_AUTO_TEST_CASE(reading_leaves_every_file_as_it_is) {
  const SmallSet set;
  set.add_field(1.25, -0.5);
  for (const bool locks : {true, false}) {
    if (!locks) {  // as in an archive that was packed without them
      for (const auto& entry : std::filesystem::recursive_directory_iterator(set.path())) {
        if (entry.path().filename() == "table.lock") std::filesystem::remove(entry.path());
      }
    }
    const std::vector<std::string> before = state_of(set.path());
    const MeasurementSet opened(set.path(), {"OTHER", "0:1~2"}, "DATA");
    opened.reach();
    BOOST_TEST(read_all(opened).counts.used == rows);
    BOOST_TEST(state_of(set.path()) == before, boost::test_tools::per_element());
  }
}

// casacore opens no MeasurementSet that lacks a column of its definition.
BOOST_AUTO_TEST_CASE(a_column_that_a_measurement_set_must_have_is_named_where_it_is_missing) {
  for (const std::string column : {"SIGMA", "FLAG_CATEGORY", "SCAN_NUMBER", "UVW"}) {
    const SmallSet set;
    set.modify([&](casacore::MeasurementSet& ms) { ms.renameColumn("OLD_" + column, column); });
    BOOST_TEST(error_of([&] { read_path(set.path()); }) ==
               set.path() + " is a table but not a MeasurementSet: it has no column " + column);
  }
}

BOOST_AUTO_TEST_CASE(cells_that_cannot_be_used_are_one_line_that_names_the_column) {
  const std::map<std::string, std::function<void(casacore::MeasurementSet&)>> damages = {
      {"WEIGHT",
       [](casacore::MeasurementSet& ms) {
         ms.removeColumn("WEIGHT");
         ms.addColumn(casacore::ArrayColumnDesc<float>("WEIGHT", 1));
         casacore::ArrayColumn<float>(ms, "WEIGHT").fillColumn(casacore::Vector<float>(3, 1.0F));
       }},
      {"DATA",
       [](casacore::MeasurementSet& ms) {
         ms.removeColumn("DATA");
         ms.addColumn(casacore::ArrayColumnDesc<casacore::Complex>("DATA", 2));
       }},
      {"FLAG", [](casacore::MeasurementSet& ms) {
         ms.removeColumn("FLAG");
         ms.addColumn(casacore::ArrayColumnDesc<bool>("FLAG", 2));
         casacore::ArrayColumn<bool>(ms, "FLAG").fillColumn(casacore::Matrix<bool>(2, channels - 1, false));
       }}};
  for (const auto& [column, damage] : damages) {
    BOOST_TEST_CONTEXT(column) {
      const SmallSet set;
      set.modify(damage);
      const std::string error = error_of([&] { read_path(set.path()); });
      BOOST_TEST(contains(error, "cannot read " + column + " of " + set.path()));
      BOOST_TEST(!contains(error, "\n"));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
