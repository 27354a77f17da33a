#include "tools/hosts/casacore_gridder.h"

#include <casacore/casa/Arrays/ArrayLogical.h>
#include <casacore/casa/Arrays/ArrayMath.h>

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>

#include "kernels/map_error.h"
#include "tests/hosts/gridded_sky.h"
#include "tests/hosts/least_misfit_file.h"

BOOST_AUTO_TEST_SUITE(casacore_gridder)

using namespace misfit;
using namespace misfit::testing;
using casacore::Array;
using casacore::Complex;
using casacore::IPosition;
using casacore::Vector;
using hosts::CasacoreGridder;
namespace bdata = boost::unit_test::data;

namespace {

constexpr int visibilities = 2000;

/// RMS rounding errors of single precision, relative to the result. Half a unit in the last place is 2^-24 at most and 2^-25.8
/// in the mean square. Corrections: three. The grid: one when it is complete, magnified by what white noise on it is magnified;
/// and where visibilities were added up, with random phases, k of them in a cell, √(k/2) more and two of each.
double rounding(const kernels::Kernel& kernel, double in_a_cell = 0) {
  constexpr double unit = 0x1p-25;
  return unit *
         (std::sqrt(3.0) + std::pow(kernels::noise_gain(kernel.polynomial, kernel.x0), 2) * (2 + std::sqrt(in_a_cell / 2)));
}

CasacoreGridder gridder_for(const LeastMisfitFile& file, const GriddedSky& sky) {
  return CasacoreGridder(file.path, sky.shape(), sky.scale(), sky.offset());
}

Vector<double> at(std::initializer_list<double> position) {
  Vector<double> p(position.size());
  std::copy(position.begin(), position.end(), p.begin());
  return p;
}

}  // namespace

BOOST_DATA_TEST_CASE(every_width_errs_as_theory_says_in_both_directions, bdata::xrange(1, 21) * bdata::make({0, 1}), width,
                     little) {
  const Size size = little != 0 ? padded_little : padded_twice;
  const LeastMisfitFile file(width, size.x0());
  GriddedSky sky = GriddedSky::random_phases(size.pixels, size.fft, visibilities);
  CasacoreGridder gridder = gridder_for(file, sky);
  const double expected = std::sqrt(sky.expected(kernels::map_error(file.kernel.polynomial, sky.x())));
  // 2000 visibilities leave 1/√2000 of a mean square that varies by itself, half of it in the root: 10% is nine such.
  constexpr double sample = 0.1;

  const double degridding = relative_error(sky.degridded(gridder), sky.visibilities());
  BOOST_TEST(std::abs(degridding - expected) < sample * expected + rounding(file.kernel));

  const Eigen::VectorXcd noise = sky.noise();
  const double in_a_cell = visibilities * std::pow(width / (size.fft - 24.0), 2);
  const double gridding = relative_error(sky.gridded(gridder, noise), sky.dirty(noise));
  BOOST_TEST(std::abs(gridding - expected) < sample * expected + rounding(file.kernel, in_a_cell));
  BOOST_TEST_MESSAGE("√(2E) of these pixels " << expected << ", degridding " << degridding << ", gridding " << gridding);
}

BOOST_AUTO_TEST_CASE(seven_cells_and_padding_2_leave_3e_7) {
  // √(2E) is 1.7e-7, to which single precision adds 0.5e-7.
  const LeastMisfitFile file(7, padded_twice.x0());
  for (GriddedSky sky : {GriddedSky::random_phases(64, 128, visibilities), GriddedSky::points(64, 128, visibilities)}) {
    CasacoreGridder gridder = gridder_for(file, sky);
    const Eigen::VectorXcd noise = sky.noise();
    const double degridding = relative_error(sky.degridded(gridder), sky.visibilities());
    const double gridding = relative_error(sky.gridded(gridder, noise), sky.dirty(noise));
    BOOST_TEST_MESSAGE("degridding " << degridding << ", gridding " << gridding);
    BOOST_TEST(degridding < 3e-7);
    BOOST_TEST(gridding < 3e-7);
  }
}

BOOST_DATA_TEST_CASE(degridding_is_the_adjoint_of_gridding_on_one_to_three_axes,
                     bdata::make({1, 2, 4, 7, 12, 20}) * bdata::make({1, 2, 3}), width, axes) {
  const LeastMisfitFile file(width, 0.25);
  const IPosition shape = IPosition(3, 25, 28, 22).getFirst(static_cast<std::size_t>(axes));
  CasacoreGridder gridder(file.path, shape, Vector<double>(shape.size(), 1.0), Vector<double>(shape.size(), 0.0));
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> part(-1, 1);
  Array<Complex> y(shape);
  for (Complex& cell : y) cell = Complex(static_cast<float>(part(generator)), static_cast<float>(part(generator)));
  for (int k = 0; k < 50; ++k) {
    Vector<double> p(shape.size());
    for (std::size_t a = 0; a < p.size(); ++a) p[a] = static_cast<double>(shape[a] - 1) / 2 + 0.9 * part(generator);
    Array<Complex> x(shape, Complex(0));
    Complex degridded;
    BOOST_REQUIRE(gridder.grid(x, p, Complex(2, -1)));
    BOOST_REQUIRE(gridder.degrid(y, p, degridded));
    std::complex<double> by_grid = 0;
    double size = 0;
    for (auto cell = x.begin(), other = y.begin(); cell != x.end(); ++cell, ++other) {
      by_grid += std::conj(std::complex<double>(*other)) * std::complex<double>(*cell);
      size += std::norm(std::complex<double>(*cell));
    }
    const std::complex<double> by_degrid = std::conj(std::complex<double>(degridded)) * std::complex<double>(2, -1);
    // Three roundings of a cell of x, independent of each other, times y of RMS √(2/3); one of the sum.
    BOOST_TEST(std::abs(by_grid - by_degrid) < 0x1p-24 * (5 * std::sqrt(3 * size) + std::abs(by_degrid)));
  }
}

BOOST_DATA_TEST_CASE(a_visibility_falls_on_the_cells_around_it, bdata::xrange(1, 21), width) {
  const LeastMisfitFile file(width, 0.25);
  CasacoreGridder gridder(file.path, IPosition(1, 40), Vector<double>(1, 2.0), Vector<double>(1, 3.0));
  for (const double position : {15.5, 15.9, 16.0, 16.25, 16.5, 16.75, 17.1}) {
    Array<Complex> grid(IPosition(1, 40), Complex(0));
    BOOST_REQUIRE(gridder.grid(grid, at({(position - 3) / 2}), Complex(0, 1)));
    const double middle = width % 2 == 1 ? std::floor(position + 0.5) : std::floor(position) + 0.5;
    const Eigen::VectorXd tap = file.kernel.polynomial(position - middle);
    for (int n = 0; n < 40; ++n) {
      const int r = static_cast<int>(std::lround(n - middle + (width - 1) / 2.0));
      const double expected = r >= 0 && r < width ? tap[r] : 0;
      BOOST_TEST(std::abs(grid(IPosition(1, n)) - Complex(0, static_cast<float>(expected))) <= 0x1p-23 * std::abs(expected));
    }
  }
}

BOOST_DATA_TEST_CASE(what_does_not_lie_on_the_grid_is_left_alone, bdata::xrange(1, 21), width) {
  const LeastMisfitFile file(width, 0.25);
  const IPosition shape(2, 40, 30);
  CasacoreGridder gridder(file.path, shape, Vector<double>(2, 1.0), Vector<double>(2, 0.0));
  const double lowest = width / 2.0 - 1;  // the first tap on cell 0
  Array<Complex> grid(shape, Complex(0));
  Complex value(7, 7);
  const auto both = [&](double u, double v) {
    const bool gridded = gridder.grid(grid, at({u, v}), Complex(1));
    BOOST_TEST(gridder.degrid(grid, at({u, v}), value) == gridded);
    return gridded;
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (const double off : {lowest - 1e-9, -5.0, 41.0 - lowest, 1e30, -1e30, nan, infinite, -infinite}) {
    BOOST_TEST(!both(off, 15));
    BOOST_TEST(!both(20, off < 0 || off <= lowest || !(off < 100) ? off : 29 - lowest));
  }
  BOOST_TEST(casacore::allEQ(grid, Complex(0)));
  BOOST_TEST((value == Complex(7, 7)));
  BOOST_TEST(both(lowest, lowest));
  BOOST_TEST(both(39 - lowest - 1e-9, 29 - lowest - 1e-9));
}

BOOST_AUTO_TEST_CASE(a_tile_of_the_grid_takes_and_gives_what_the_whole_would) {
  for (const int width : {6, 7}) {
    const LeastMisfitFile file(width, 0.25);
    const IPosition shape(2, 50, 60);
    CasacoreGridder gridder(file.path, shape, Vector<double>(2, 1.0), Vector<double>(2, 0.0));
    Array<Complex> whole(shape, Complex(0)), tile(IPosition(2, 16, 12), Complex(0));
    const Vector<double> position = at({27.3, 36.6});
    Complex of_whole, of_tile;
    BOOST_TEST(gridder.grid(whole, position, Complex(1, 2)));
    BOOST_TEST(gridder.degrid(whole, position, of_whole));
    gridder.setOffset(IPosition(2, 20, 31));
    BOOST_TEST(gridder.grid(tile, position, Complex(1, 2)));
    BOOST_TEST(gridder.degrid(tile, position, of_tile));
    const Array<Complex> part = whole(IPosition(2, 20, 31), IPosition(2, 35, 42));
    // Subtracting an offset leaves a position of 37 uncertain by 2^-48, too little for single precision but where it rounds.
    BOOST_TEST(casacore::allNearAbs(part, tile, 0x1p-22));
    BOOST_TEST(std::abs(of_whole - of_tile) < 0x1p-22);
    BOOST_TEST(!gridder.grid(tile, at({21.9, 36}), Complex(1)));
    BOOST_TEST(!gridder.grid(tile, at({27, 41}), Complex(1)));  // on the gridder's shape, but not on this tile
  }
}

BOOST_AUTO_TEST_CASE(arrays_in_pieces_and_planes_of_more_axes_serve_like_others) {
  const LeastMisfitFile file(7, 0.25);
  const IPosition shape(2, 20, 18);
  CasacoreGridder gridder(file.path, shape, Vector<double>(2, 1.0), Vector<double>(2, 0.0));
  const Vector<double> position = at({9.7, 8.1});
  Array<Complex> plain(shape, Complex(0));
  Complex expected;
  BOOST_TEST(gridder.grid(plain, position, Complex(1, 2)));
  BOOST_TEST(gridder.degrid(plain, position, expected));

  Array<Complex> large(IPosition(4, 60, 40, 2, 3), Complex(0));
  for (const IPosition& stride : {IPosition(4, 1, 1, 1, 1), IPosition(4, 1, 2, 1, 1), IPosition(4, 3, 2, 1, 1)}) {
    large = Complex(0);
    const IPosition first(4, 2, 3, 1, 2);
    const IPosition last = first + IPosition(4, 19, 17, 0, 0) * stride;
    Array<Complex> piece = large(first, last, stride);
    BOOST_TEST(!piece.contiguousStorage());
    BOOST_TEST(gridder.grid(piece, position, Complex(1, 2)));
    BOOST_TEST(casacore::allNearAbs(piece.nonDegenerate(), plain, 0x1p-23));
    BOOST_TEST(std::abs(casacore::sum(large) - casacore::sum(plain)) < 1e-5);  // nothing beside it: 49 roundings of 1
    Complex found;
    BOOST_TEST(gridder.degrid(piece, position, found));
    BOOST_TEST(std::abs(found - expected) < 0x1p-22);
  }
}

BOOST_AUTO_TEST_CASE(corrections_are_one_over_h_inside_and_finite_everywhere) {
  for (const double x0 : {0.05, 0.25, 5.0 / 12}) {
    for (const int width : {1, 2, 7, 14, 20}) {
      const LeastMisfitFile file(width, x0);
      constexpr int size = 90, other = 77;
      CasacoreGridder gridder(file.path, IPosition(2, size, other), Vector<double>(2, 1.0), Vector<double>(2, 0.0));
      const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(size, -45, 44) / size;
      const Eigen::VectorXd y = Eigen::VectorXd::LinSpaced(other, -38, 38) / other;
      const Eigen::VectorXd h_x = kernels::optimal_correction(file.kernel.polynomial, x);
      const Eigen::VectorXd h_y = kernels::optimal_correction(file.kernel.polynomial, y);
      for (int m = 0; m < other; ++m) {
        Vector<Complex> line(size);
        gridder.correctX1D(line, m);
        for (int l = 0; l < size; ++l) {
          const Complex divisor = gridder.correct(IPosition(2, l, m));
          BOOST_TEST((divisor == line[static_cast<std::size_t>(l)]));
          const Complex corrected = Complex(1, -1) / divisor;
          BOOST_TEST((std::isfinite(corrected.real()) && std::isfinite(corrected.imag())));
          if (std::abs(x[l]) <= x0 && std::abs(y[m]) <= x0)  // three roundings
            BOOST_TEST(std::abs(std::complex<double>(divisor) * (h_x[l] * h_y[m]) - 1.0) < 3 * 0x1p-24);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(the_support_is_that_of_the_cells_that_may_be_touched) {
  for (const auto& [width, support] : {std::pair{1, 0}, {2, 1}, {6, 3}, {7, 3}, {20, 10}}) {
    const LeastMisfitFile file(width, 0.25);
    const CasacoreGridder gridder(file.path, IPosition(2, 40, 40), Vector<double>(2, 1.0), Vector<double>(2, 0.0));
    BOOST_TEST(gridder.cSupport().size() == 2U);
    BOOST_TEST(casacore::allEQ(gridder.cSupport(), support));
    BOOST_TEST(gridder.kernel().width() == width);
  }
}

BOOST_AUTO_TEST_CASE(what_is_no_kernel_or_no_grid_is_refused) {
  const LeastMisfitFile file(7, 0.25);
  const auto refused = [](const std::string& path) {
    BOOST_CHECK_EXCEPTION(
        CasacoreGridder(path, IPosition(1, 40), Vector<double>(1, 1.0), Vector<double>(1, 0.0)), std::runtime_error,
        [&](const std::runtime_error& error) { return std::string(error.what()).find(path) != std::string::npos; });
  };
  refused(file.folder / "missing.fits");
  const std::string damaged = file.folder / "damaged.fits", empty = file.folder / "empty.fits";
  std::ofstream(empty).close();
  refused(empty);
  std::filesystem::copy_file(file.path, damaged);
  std::fstream(damaged, std::ios::in | std::ios::out | std::ios::binary).seekp(-2000, std::ios::end).put('x');
  refused(damaged);

  const auto wrong = [&](std::size_t axes, std::size_t scales, std::size_t offsets) {
    BOOST_CHECK_THROW(
        CasacoreGridder(file.path, IPosition(axes, 40), Vector<double>(scales, 1.0), Vector<double>(offsets, 0.0)),
        std::invalid_argument);
  };
  wrong(0, 0, 0);
  wrong(4, 4, 4);
  wrong(2, 1, 2);
  wrong(2, 2, 3);
  CasacoreGridder gridder(file.path, IPosition(2, 40, 40), Vector<double>(2, 1.0), Vector<double>(2, 0.0));
  Array<Complex> line(IPosition(1, 40), Complex(0)), plane(IPosition(2, 40, 40), Complex(0));
  BOOST_CHECK_THROW(gridder.grid(line, at({20, 20}), Complex(1)), std::invalid_argument);
  BOOST_CHECK_THROW(gridder.grid(plane, at({20}), Complex(1)), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
