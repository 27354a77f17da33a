// What a run leaves that is killed while it writes a column, at every place where it changes a file, and what the next run
// makes of it.
#include <casacore/tables/DataMan/StandardStMan.h>
#include <casacore/tables/DataMan/TiledShapeStMan.h>

#include <boost/test/unit_test.hpp>
#include <fstream>
#include <map>

#include "ms_io/model_writer.h"
#include "tests/faults/traced_process.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(killed_run)

using namespace testing;

namespace {

namespace fs = std::filesystem;
using casacore::Complex;
using Cells = std::vector<std::vector<Complex>>;  ///< by row; empty where a cell has no shape

/// Two fields and two spectral windows; one field is selected, and some channels.
struct MixedSet : SmallSet {
  MixedSet() {
    add_field(1.5, -0.25);
    add_spectral_window();
  }
};
const Selection selection{"1", "0~1:1~4"};

/// Copies of a set, one after the other, while it changes.
class CopiedSet : public SmallSet {
 public:
  explicit CopiedSet(const SmallSet& set) {
    fs::remove_all(path());
    fs::copy(set.path(), path(), fs::copy_options::recursive);
  }

  /// Becomes what the set is now, its subtables apart. False where that differs from the last copy at most in files that wait
  /// to be renamed, or in a folder that only the next run looks at, to remove it.
  bool follow(const SmallSet& set) {
    std::map<fs::path, std::string> files;
    for (const fs::path& file : main_files(set.path())) {
      if (file.extension() == ".part" || file.filename() == "table.dat_tmp") continue;
      std::string& contents = files[file];
      if (!fs::is_regular_file(file)) continue;
      contents.resize(fs::file_size(file));
      std::ifstream(file, std::ios::binary).read(contents.data(), static_cast<std::streamsize>(contents.size()));
    }
    if (files == files_) return false;
    files_ = std::move(files);
    for (const fs::path& file : main_files(path())) fs::remove_all(file);
    for (const fs::path& file : main_files(set.path())) {
      fs::copy(file, fs::path(path()) / file.filename(), fs::copy_options::recursive | fs::copy_options::copy_symlinks);
    }
    return true;
  }

 private:
  static std::vector<fs::path> main_files(const std::string& path) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
      if (!fs::exists(entry.path() / "table.lock")) files.push_back(entry);
    }
    return files;
  }

  std::map<fs::path, std::string> files_;  ///< copied last
};

/// Everything of a set that a run may not lose, as plain casacore reads it.
struct State {
  Cells column, data;
  std::string type;

  State(const SmallSet& set, const std::string& name) : column(rows), data(rows) {
    const casacore::MeasurementSet ms(set.path());
    type = ms.tableInfo().type() + ms.tableInfo().readme();
    const casacore::ArrayColumn<Complex> stored(ms, "DATA");
    for (std::size_t r = 0; r < rows; ++r) data[r] = stored(r).tovector();
    if (!ms.tableDesc().isColumn(name)) return;
    const casacore::ArrayColumn<Complex> values(ms, name);
    for (std::size_t r = 0; r < rows; ++r) {
      if (values.isDefined(r)) column[r] = values(r).tovector();
    }
  }
};

/// What the run told.
std::string write(const SmallSet& set, ModelColumn column) {
  std::string told;
  column.origin = {"misfit predict --model a.fits", 1, [&](const std::string& sentence) { told += sentence; }};
  write_model(set.path(), selection, column, small_visibilities, {}, {24});
  return told;
}

/// Whether every value is that of one of three stages; a cell may lack that had no shape before.
bool of_stages(const Cells& cells, const Cells& before, const Cells& blank, const Cells& after) {
  for (std::size_t r = 0; r < rows; ++r) {
    if (cells[r].empty() && before[r].empty()) continue;
    if (cells[r].size() != after[r].size()) return false;
    const std::vector<Complex>& begin = before[r].empty() ? blank[r] : before[r];
    for (std::size_t k = 0; k < cells[r].size(); ++k) {
      if (cells[r][k] != begin[k] && cells[r][k] != after[r][k]) return false;
    }
  }
  return true;
}

void check_kills(const SmallSet& set, const ModelColumn& column) {
  const CopiedSet whole(set);
  CopiedSet left(set);
  const State before(set, column.name);
  write(whole, column);
  const State after(whole, column.name);
  const Cells blank = column.subtracted_from.empty() ? Cells(rows, std::vector<Complex>(2 * channels)) : before.data;
  int kills = 0, states = 0;
  const auto look = [&] {
    ++kills;
    if (!left.follow(set)) return;
    ++states;
    BOOST_TEST_CONTEXT("killed before change " << kills) {
      const State state(left, column.name);
      BOOST_TEST((state.data == before.data));
      BOOST_TEST(state.type == before.type);
      BOOST_TEST(of_stages(state.column, before.column, blank, after.column));
      const std::string incomplete = incomplete_column(left.path(), column.name);
      if (column.in_place() && incomplete.empty() && state.column == after.column) {
        BOOST_TEST(contains(error_of([&] { write(left, column); }), "has already been subtracted from"));
      } else {
        BOOST_TEST(write(left, column) == (incomplete.empty() ? "" : incomplete + ", going on"));
      }
      BOOST_TEST((State(left, column.name).column == after.column));
    }
  };
  const auto before_change = [&](const misfit::testing::SystemCall& call) {
    if (call.changes_file()) look();
    return misfit::testing::Answer{};
  };
  BOOST_TEST(misfit::testing::trace([&] { write(set, column); }, misfit::testing::changing_calls, before_change) == 0);
  BOOST_TEST(states > 10);
  BOOST_TEST((State(set, column.name).column == after.column));
}

enum class Shapes { fixed, given, missing };

/// With a column that another program made.
struct SetWithColumn : MixedSet {
  SetWithColumn(const std::string& name, const casacore::DataManager& manager, Shapes shapes) {
    modify([&](casacore::MeasurementSet& ms) {
      using Description = casacore::ArrayColumnDesc<Complex>;
      ms.addColumn(shapes == Shapes::fixed ? Description(name, casacore::IPosition(2, 2, channels),
                                                         casacore::ColumnDesc::FixedShape | casacore::ColumnDesc::Direct)
                                           : Description(name, 2),
                   manager);
      casacore::ArrayColumn<Complex> cells(ms, name);
      for (std::size_t r = 0; r < (shapes == Shapes::missing ? rows / 2 : rows); ++r) {
        cells.put(r, casacore::Matrix<Complex>(2, channels, Complex(static_cast<float>(r), 5)));
      }
    });
  }
};

const casacore::TiledShapeStMan tiled("Model", casacore::IPosition(3, 2, 4, 15));  // whose tiles split cells
const casacore::StandardStMan standard("Model");

}  // namespace

BOOST_AUTO_TEST_CASE(while_it_makes_a_column) {
  check_kills(MixedSet(), {"CORRECTED_DATA", "DATA", false});
}

BOOST_AUTO_TEST_CASE(while_it_fills_tiles) {
  check_kills(SetWithColumn("MODEL_DATA", tiled, Shapes::given), {"MODEL_DATA"});
}

BOOST_AUTO_TEST_CASE(while_it_fills_buckets) {
  check_kills(SetWithColumn("MODEL_DATA", standard, Shapes::fixed), {"MODEL_DATA"});
}

BOOST_AUTO_TEST_CASE(while_it_fills_an_array_file) {
  check_kills(SetWithColumn("MODEL_DATA", standard, Shapes::given), {"MODEL_DATA"});
}

BOOST_AUTO_TEST_CASE(while_it_makes_cells) {
  check_kills(SetWithColumn("MODEL_DATA", tiled, Shapes::missing), {"MODEL_DATA"});
}

BOOST_AUTO_TEST_CASE(while_it_subtracts_in_place) {
  const ModelColumn in_place{"CORRECTED_DATA", "CORRECTED_DATA"};
  check_kills(SetWithColumn("CORRECTED_DATA", tiled, Shapes::given), in_place);
  check_kills(SetWithColumn("CORRECTED_DATA", standard, Shapes::fixed), in_place);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
