// Headers of tiled storage managers, any four bytes of which are others. casacore would divide by 0, look past the end of what
// it has, or take gigabytes.
#include <casacore/images/Images/PagedImage.h>
#include <casacore/tables/DataMan/TiledColumnStMan.h>
#include <casacore/tables/DataMan/TiledDataStMan.h>
#include <casacore/tables/DataMan/TiledDataStManAccessor.h>
#include <casacore/tables/DataMan/TiledShapeStMan.h>
#include <casacore/tables/Tables/ScaColDesc.h>
#include <casacore/tables/Tables/SetupNewTab.h>
#include <casacore/tables/Tables/TableDesc.h>
#include <sys/stat.h>

#include <boost/test/unit_test.hpp>

#include "ms_io/casa_image.h"
#include "ms_io/storage_managers_internal.h"
#include "tests/example_cube.h"
#include "tests/ms_io/damaged_files.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(tiled_headers)

using namespace testing;

namespace {

namespace fs = std::filesystem;

void read_cells(const std::string& path, const std::string& column) {
  check_storage_managers(path);
  const casacore::Table table(path, casacore::TableLock(casacore::TableLock::NoLocking));
  const casacore::ArrayColumn<float> cells(table, column);
  for (casacore::rownr_t row = 0; row < table.nrow(); ++row)
    if (cells.isDefined(row) && cells.shape(row).product() <= 1000) cells.get(row);
  if ((cells.columnDesc().options() & casacore::ColumnDesc::FixedShape) != 0) cells.getColumn();
}

/// Every pixel has a value, so that there is no mask.
void make_image(const std::string& path) {
  const imager::ImageHeader header = misfit::testing::example_header(1);
  const auto writer = create_casa_image(header, path);
  writer->write({0, 0}, misfit::testing::example_plane(header, {0, 0}), std::nullopt);
  writer->finish();
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_image_is_read_or_refused) {
  const TemporaryFolder folder;
  make_image(folder / "a.image");
  check_every_number(header_of(folder / "a.image", "TiledCellStMan"), [&] {
    const auto image = open_casa_image(folder / "a.image");
    if (image->header().geometry.pixels() <= 1000) image->read({0, 0});
  });
}

BOOST_AUTO_TEST_CASE(an_image_of_more_pixels_than_its_files_hold_is_refused) {
  const TemporaryFolder folder;
  make_image(folder / "a.image");
  const std::string file = header_of(folder / "a.image", "TiledCellStMan");
  std::string bytes = bytes_of(file);
  const std::string shape("\0\0\0\7\0\0\0\4\0\0\0\1", 12), larger("\0\0\x7\0\0\0\x4\0\0\0\0\1", 12);
  const std::size_t cube = bytes.find(shape, bytes.find("TiledStMan"));
  bytes.replace(cube, larger.size(), larger);  // and not the tiles
  std::ofstream(file, std::ios::binary) << bytes;
  BOOST_CHECK_EXCEPTION(open_casa_image(folder / "a.image"), std::runtime_error, [](const std::exception& error) {
    return std::string(error.what()).find("its pixels take 7.34003e+06 bytes, expected no more than the ") != std::string::npos;
  });
}

BOOST_AUTO_TEST_CASE(cells_of_one_shape_are_read_or_refused) {
  const SmallSet set;
  check_every_number(header_of(set.path(), "TiledColumnStMan"), [&] { read_cells(set.path(), "WEIGHT"); });
}

BOOST_AUTO_TEST_CASE(cells_of_many_shapes_are_read_or_refused) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.table";
  {
    casacore::TableDesc description;
    description.addColumn(casacore::ArrayColumnDesc<float>("CELLS", 2));
    description.defineHypercolumn("Tiled", 3, casacore::Vector<casacore::String>(1, "CELLS"));
    casacore::SetupNewTable setup(path, description, casacore::Table::New);
    setup.bindAll(casacore::TiledShapeStMan("Tiled", casacore::IPosition(3, 2, 3, 4)));
    casacore::Table table(setup, 6);
    casacore::ArrayColumn<float> cells(table, "CELLS");
    for (casacore::rownr_t row = 0; row < 6; ++row)
      cells.put(row, casacore::Array<float>(casacore::IPosition(2, 2, row < 3 ? 3 : 5), static_cast<float>(row)));
  }
  check_every_number(header_of(path, "TiledShapeStMan"), [&] { read_cells(path, "CELLS"); });
}

BOOST_AUTO_TEST_CASE(cells_of_hypercubes_told_apart_by_values_are_read_or_refused) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.table";
  {
    casacore::TableDesc description;
    description.addColumn(
        casacore::ArrayColumnDesc<float>("CELLS", casacore::IPosition(2, 2, 3), casacore::ColumnDesc::FixedShape));
    description.addColumn(casacore::ScalarColumnDesc<int>("ID"));
    description.defineHypercolumn("Tiled", 3, casacore::Vector<casacore::String>(1, "CELLS"),
                                  casacore::Vector<casacore::String>(), casacore::Vector<casacore::String>(1, "ID"));
    casacore::SetupNewTable setup(path, description, casacore::Table::New);
    casacore::TiledDataStMan manager("Tiled");
    setup.bindAll(manager);
    casacore::Table table(setup, 6);
    casacore::TiledDataStManAccessor tiles(table, "Tiled");
    for (const int id : {7, 8}) {
      casacore::Record values;
      values.define("ID", id);
      tiles.addHypercube(casacore::IPosition(3, 2, 3, 3), casacore::IPosition(3, 2, 3, 2), values);
    }
    casacore::ArrayColumn<float> cells(table, "CELLS");
    for (casacore::rownr_t row = 0; row < 6; ++row) cells.put(row, casacore::Array<float>(casacore::IPosition(2, 2, 3), 1.0F));
  }
  check_every_number(header_of(path, "TiledDataStMan"), [&] { read_cells(path, "CELLS"); });
}

BOOST_AUTO_TEST_CASE(cells_are_of_the_shape_that_their_column_has) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.table";
  {
    casacore::TableDesc description;
    description.addColumn(
        casacore::ArrayColumnDesc<float>("CELLS", casacore::IPosition(2, 2, 3), casacore::ColumnDesc::FixedShape));
    description.defineHypercolumn("Tiled", 3, casacore::Vector<casacore::String>(1, "CELLS"));
    casacore::SetupNewTable setup(path, description, casacore::Table::New);
    setup.bindAll(casacore::TiledColumnStMan("Tiled", casacore::IPosition(3, 2, 3, 4)));
    casacore::ArrayColumn<float>(casacore::Table(setup, 6), "CELLS")
        .fillColumn(casacore::Array<float>(casacore::IPosition(2, 2, 3), 1.0F));
  }
  check_every_number(path + "/table.dat", [&] { read_cells(path, "CELLS"); });
}

BOOST_AUTO_TEST_CASE(what_is_no_file_is_named) {
  const SmallSet set;
  const std::string file = header_of(set.path(), "TiledColumnStMan");
  for (const bool pipe : {false, true}) {
    fs::remove(file);
    if (pipe)
      mkfifo(file.c_str(), 0600);
    else
      fs::create_directory(file);
    BOOST_CHECK_EXCEPTION(check_storage_managers(set.path()), std::runtime_error, [&](const std::exception& error) {
      return std::string(error.what()).find("cannot read " + file + ": it is no regular file") != std::string::npos;
    });
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
