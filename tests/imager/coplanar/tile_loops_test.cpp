#include "imager/coplanar/tile_loops.h"

#include "tests/imager/loop_checks.h"

BOOST_AUTO_TEST_SUITE(tile_loops)

using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr int tile = 16;

/// Every third sample lies in the cell of the one before it.
template <typename Real>
TileBatch<Real> random_batch(int count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<Real> uniform(-1, 1);
  TileBatch<Real> batch;
  batch.count = count;
  for (int i = 0; i < count; ++i) {
    batch.column[i] = static_cast<int>(random() % tile);
    batch.row[i] = static_cast<int>(random() % tile);
    for (auto& value : batch.value) value[i] = uniform(random);
    batch.tu[i] = uniform(random) / 2;
    batch.tv[i] = uniform(random) / 2;
    if (i % 3 == 2) batch.column[i] = batch.column[i - 1], batch.row[i] = batch.row[i - 1];
  }
  if (count > 1) batch.column[0] = batch.row[0] = tile - 1, batch.column[1] = batch.row[1] = 0;
  return batch;
}

template <typename Real>
TileBuffer<Real> random_buffer(int padded, int planes) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<Real> uniform(-1, 1);
  TileBuffer<Real> buffer(tile, padded, planes);
  for (Real& cell : buffer.cell) cell = uniform(random);
  return buffer;
}

template <typename Real>
std::size_t index(const TileBuffer<Real>& buffer, int row, int plane, int column) {
  const int i = (row * buffer.planes + plane) * buffer.columns + column;
  return static_cast<std::size_t>(i);
}

}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(spread_adds_the_plain_double_loop_for_every_width_and_instruction_set, Real, Precisions) {
  for_each_width_and_target([](int width) {
    const auto u = random_polynomial(width, 3), v = random_polynomial(width, 4);
    const TapTable<Real> table_u(u), table_v(v);
    for (const int planes : {1, 2, 3, 4, most_grid_planes})
      for (const int count : {0, 1, 20}) {
        const TileBatch<Real> batch = random_batch<Real>(count);
        TileBuffer<Real> buffer = random_buffer<Real>(table_u.padded, planes);
        std::vector<double> should(buffer.cell.begin(), buffer.cell.end());
        for (int i = 0; i < count; ++i) {
          const Eigen::VectorXd along_u = u(double{batch.tu[i]}), along_v = v(double{batch.tv[i]});
          for (int r = 0; r < width; ++r)
            for (int plane = 0; plane < planes; ++plane)
              for (int c = 0; c < width; ++c)
                should[index(buffer, batch.row[i] + r, plane, batch.column[i] + c)] +=
                    along_u[c] * along_v[r] * double{batch.value[plane][i]};
        }
        spread(table_u, table_v, batch, buffer.cells());
        double largest = 0;
        for (std::size_t i = 0; i < should.size(); ++i) largest = std::max(largest, std::abs(buffer.cell[i] - should[i]));
        BOOST_TEST(largest <= rounding<Real>(count));
      }
  });
}

BOOST_AUTO_TEST_CASE_TEMPLATE(interpolation_is_the_plain_double_sum_for_every_width_and_instruction_set, Real, Precisions) {
  for_each_width_and_target([](int width) {
    const auto u = random_polynomial(width, 5), v = random_polynomial(width, 6);
    const TapTable<Real> table_u(u), table_v(v);
    TileBuffer<Real> buffer = random_buffer<Real>(table_u.padded, 2);
    TileBatch<Real> batch = random_batch<Real>(TileBatch<Real>::capacity);
    interpolate(table_u, table_v, buffer.cells(), batch);
    double largest = 0;
    for (int i = 0; i < batch.count; ++i) {
      const Eigen::VectorXd along_u = u(double{batch.tu[i]}), along_v = v(double{batch.tv[i]});
      double real = 0, imaginary = 0;
      for (int r = 0; r < width; ++r)
        for (int c = 0; c < width; ++c) {
          real += along_u[c] * along_v[r] * double{buffer.cell[index(buffer, batch.row[i] + r, 0, batch.column[i] + c)]};
          imaginary += along_u[c] * along_v[r] * double{buffer.cell[index(buffer, batch.row[i] + r, 1, batch.column[i] + c)]};
        }
      largest = std::max({largest, std::abs(batch.value[0][i] - real), std::abs(batch.value[1][i] - imaginary)});
    }
    BOOST_TEST(largest <= rounding<Real>(width * width));
  });
}

BOOST_AUTO_TEST_CASE_TEMPLATE(spreading_is_the_transpose_of_interpolating_for_every_width_and_instruction_set, Real,
                              Precisions) {
  for_each_width_and_target([](int width) {
    const TapTable<Real> u(random_polynomial(width, 8)), v(random_polynomial(width, 9));
    TileBuffer<Real> y = random_buffer<Real>(u.padded, 2);
    const TileBatch<Real> x = random_batch<Real>(30);
    TileBuffer<Real> spread_x(tile, u.padded, 2);
    spread(u, v, x, spread_x.cells());
    TileBatch<Real> y_at_x = x;
    interpolate(u, v, y.cells(), y_at_x);
    double in_buffer = 0, in_samples = 0;
    for (std::size_t i = 0; i < y.cell.size(); ++i) in_buffer += double{spread_x.cell[i]} * double{y.cell[i]};
    for (int i = 0; i < x.count; ++i)
      in_samples += double{x.value[0][i]} * double{y_at_x.value[0][i]} + double{x.value[1][i]} * double{y_at_x.value[1][i]};
    // Both are sums of 2 · 30 · W² products of a value, two taps and a cell.
    BOOST_TEST(std::abs(in_buffer - in_samples) <= 2 * 30 * rounding<Real>(width * width));
  });
}

BOOST_AUTO_TEST_CASE(a_kernel_wider_than_the_loops_is_refused) {
  BOOST_CHECK_THROW(TapTable<float>(random_polynomial(21, 7)), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
