#include "imager/weighting/cell_values.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <random>
#include <set>

#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(cell_values)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double cell_rad = 1e-5;

const auto sizes = bdata::make({64, 33, 20, 8}) ^ bdata::make({48, 31, 51, 2});

}  // namespace

BOOST_DATA_TEST_CASE(every_cell_has_a_place_of_its_own_in_the_tiles, sizes, width, height) {
  const UvCells cells(ImageGeometry{width, height, cell_rad, {}});
  std::set<std::uint32_t> places;
  for (int row = 0; row < cells.rows(); ++row)
    for (int column = 0; column < cells.columns(); ++column) places.insert(cells.place(row, column));
  BOOST_TEST(places.size() == cells.count());
  BOOST_TEST(*places.rbegin() < cells.tiles() * UvCells::tile_cells);
}

BOOST_DATA_TEST_CASE(places_of_samples_are_those_of_their_cells, sizes, width, height) {
  const UvCells cells(ImageGeometry{width, height, cell_rad, {}});
  const VisibilityBlock block = random_samples(200, 3, cell_rad, 1, 1.2);
  const std::vector<double> turns = cells.turns_per_m(block.frequency_hz);
  std::vector<std::uint32_t> cell(3), place(3);
  for (std::size_t row = 0; row < block.rows(); ++row) {
    cells.of_row(&block.uvw_m[3 * row], turns, cell.data());
    cells.places_of_row(&block.uvw_m[3 * row], turns, place.data());
    for (std::size_t c = 0; c < cell.size(); ++c) {
      const auto columns = static_cast<std::uint32_t>(cells.columns());
      const bool outside = cell[c] == UvCells::outside;
      const auto expected =
          outside ? UvCells::outside : cells.place(static_cast<int>(cell[c] / columns), static_cast<int>(cell[c] % columns));
      BOOST_TEST(place[c] == expected);
    }
  }
}

BOOST_DATA_TEST_CASE(tiles_hold_what_dense_cells_do, sizes, width, height) {
  const UvCells cells(ImageGeometry{width, height, cell_rad, {}});
  DenseCells<double> dense(cells);
  CellTiles<double> tiles(cells);
  std::mt19937 random(1);
  for (int i = 0; i < 5; ++i) {
    const int row = static_cast<int>(random()) & 0xffff, column = static_cast<int>(random()) & 0xffff;
    dense.set(row % cells.rows(), column % cells.columns(), i + 1);
    tiles.set(row % cells.rows(), column % cells.columns(), i + 1);
  }
  std::vector<double> room, of_dense, of_tiles;
  const auto dense_factor = dense.map([](double w) { return 1 / w; });
  const auto factor = tiles.map([](double w) { return 1 / w; });
  for (int row = 0; row < cells.rows(); ++row)
    for (int column = 0; column < cells.columns(); ++column) {
      const auto cell = static_cast<std::size_t>(row * cells.columns() + column);
      BOOST_TEST(tiles.at(cells.place(row, column)) == dense[cell]);
      BOOST_TEST(tiles.row(row, room)[column] == dense[cell]);
      BOOST_TEST(factor.at(cells.place(row, column)) == dense_factor[cell]);
    }
  const auto above_0 = [](std::vector<double>& list) {
    return [&list](double value) {
      if (value > 0) list.push_back(value);
    };
  };
  dense.for_each(above_0(of_dense));
  tiles.for_each(above_0(of_tiles));
  BOOST_TEST(of_tiles == of_dense, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_SUITE_END()
