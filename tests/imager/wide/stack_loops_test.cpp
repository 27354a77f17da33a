#include "imager/wide/stack_loops.h"

#include "imager/wide/plane_stack.h"
#include "tests/imager/loop_checks.h"

BOOST_AUTO_TEST_SUITE(stack_loops)

using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr int tile = 32;
constexpr int planes = 5;

template <typename Real>
struct Kernels {
  kernels::PiecewisePolynomial u, v, w;
  StackTaps<Real> taps;

  Kernels(int width, int width_w)
      : u(random_polynomial(width, 3)),
        v(random_polynomial(width, 4)),
        w(random_polynomial(width_w, 5)),
        taps{TapTable<Real>(u), TapTable<Real>(v), TapTable<Real>(w)} {}
};

/// All over a tile, alone in their cells and up to six in one, and over planes that lie below, within and above those held; as
/// many as fill no vector.
template <typename Real>
StackBatch<Real> random_batch(int width_w, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<Real> uniform(-1, 1);
  StackBatch<Real> batch;
  batch.count = 37;
  for (int i = 0; i < batch.count; ++i) {
    batch.column[i] = i < 2 ? 31 * i : static_cast<int>(random() % tile);
    batch.row[i] = i < 2 ? 31 * i : static_cast<int>(random() % tile);
    batch.plane[i] = static_cast<int>(random() % static_cast<unsigned>(planes + width_w + 1)) - width_w;
    if (i % 8 >= 3) {
      batch.column[i] = batch.column[i - 1];
      batch.row[i] = batch.row[i - 1];
      batch.plane[i] = batch.plane[i - 1];
    }
    for (Real* t : {batch.tu, batch.tv, batch.tw}) t[i] = uniform(random) / 2;
    for (auto& grid : batch.value) grid[i] = {uniform(random), uniform(random)};
  }
  return batch;
}

/// The cells of a tile in a buffer of its own, and where they lie in a stack.
template <typename Real>
struct Places {
  StackBuffer<Real> buffer;
  PlaneStack<Real> stack;

  Places(int width, int grids) : buffer(tile, width, grids), stack({96, 96, width, tile}, grids) {
    buffer.reserve(planes);
    stack.reserve(planes, 3);
    stack.use_tiles({{1, 1}}, 1);
  }
  std::complex<Real>& in_buffer(int plane, int row, int grid, int column) { return buffer.row(plane, row, grid)[column]; }
  std::complex<Real>& in_stack(int plane, int row, int grid, int column) {
    return stack.chunk(tile + row, 1 + column / tile, plane, grid)[column % tile];
  }
  StackCells<std::complex<Real>> stack_cells() { return stack.cells_of(1, 1, 0, planes); }

  /// Calls visit(plane, row, grid, column) for all cells that taps of the tile can reach.
  template <typename Visit>
  void for_each(int width, const Visit& visit) {
    for (int plane = 0; plane < planes; ++plane)
      for (int row = 0; row < tile + width - 1; ++row)
        for (int grid = 0; grid < buffer.grids; ++grid)
          for (int column = 0; column < tile + width - 1; ++column) visit(plane, row, grid, column);
  }
  void randomize(int width) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<Real> uniform(-1, 1);
    for_each(width, [&](int plane, int row, int grid, int column) {
      in_buffer(plane, row, grid, column) = in_stack(plane, row, grid, column) = {uniform(random), uniform(random)};
    });
  }
};

/// Calls visit(sample, plane, row, column, product of taps) for the taps within the planes.
template <typename Real, typename Visit>
void for_each_tap(const Kernels<Real>& k, const StackBatch<Real>& batch, const Visit& visit) {
  for (int i = 0; i < batch.count; ++i) {
    const Eigen::VectorXd u = k.u(double{batch.tu[i]}), v = k.v(double{batch.tv[i]}), w = k.w(double{batch.tw[i]});
    for (int p = 0; p < w.size(); ++p)
      for (int r = 0; r < v.size(); ++r)
        for (int c = 0; c < u.size(); ++c)
          if (batch.plane[i] + p >= 0 && batch.plane[i] + p < planes)
            visit(i, batch.plane[i] + p, batch.row[i] + r, batch.column[i] + c, u[c] * v[r] * w[p]);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(spread_adds_the_plain_double_loop_in_a_buffer_and_in_the_stack, Real, Precisions) {
  for_each_width_and_target([](int width) {
    const int width_w = 1 + width % 7;
    const Kernels<Real> k(width, width_w);
    for (const int grids : {1, 2, most_grids}) {
      Places<Real> places(width, grids);
      places.randomize(width);
      Places<double> should(width, grids);
      should.for_each(width, [&](int plane, int row, int grid, int column) {
        should.in_buffer(plane, row, grid, column) = std::complex<double>(places.in_buffer(plane, row, grid, column));
      });
      const StackBatch<Real> batch = random_batch<Real>(width_w, 1);
      for_each_tap(k, batch, [&](int i, int plane, int row, int column, double tap) {
        for (int grid = 0; grid < grids; ++grid)
          should.in_buffer(plane, row, grid, column) += tap * std::complex<double>(batch.value[grid][i]);
      });
      spread(k.taps, batch, places.buffer.cells());
      spread(k.taps, batch, places.stack_cells());
      double largest = 0;
      should.for_each(width, [&](int plane, int row, int grid, int column) {
        const std::complex<double> value = should.in_buffer(plane, row, grid, column);
        largest = std::max({largest, std::abs(std::complex<double>(places.in_buffer(plane, row, grid, column)) - value),
                            std::abs(std::complex<double>(places.in_stack(plane, row, grid, column)) - value)});
      });
      BOOST_TEST(largest <= 2 * rounding<Real>(batch.count));  // a third tap at most doubles a term
    }
  });
}

BOOST_AUTO_TEST_CASE_TEMPLATE(interpolation_is_the_plain_double_sum_in_a_buffer_and_in_the_stack, Real, Precisions) {
  for_each_width_and_target([](int width) {
    const int width_w = 1 + width % 7;
    const Kernels<Real> k(width, width_w);
    Places<Real> places(width, 1);
    places.randomize(width);
    StackBatch<Real> of_buffer = random_batch<Real>(width_w, 2), of_stack = of_buffer;
    std::vector<std::complex<double>> should(static_cast<std::size_t>(of_buffer.count));
    for_each_tap(k, of_buffer, [&](int i, int plane, int row, int column, double tap) {
      should[static_cast<std::size_t>(i)] += tap * std::complex<double>(places.in_buffer(plane, row, 0, column));
    });
    interpolate(k.taps, places.buffer.cells(), of_buffer);
    interpolate(k.taps, places.stack_cells(), of_stack);
    double largest = 0;
    for (int i = 0; i < of_buffer.count; ++i)
      for (const StackBatch<Real>* batch : {&of_buffer, &of_stack})
        largest = std::max(largest, std::abs(std::complex<double>(batch->value[0][i]) - should[static_cast<std::size_t>(i)]));
    BOOST_TEST(largest <= 2 * rounding<Real>(width * width * width_w));
  });
}

BOOST_AUTO_TEST_SUITE_END()
