#include "imager/coplanar/half_grid.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "imager/numerics/constants.h"
#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(half_grid)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using misfit::imager::testing::norm;
using misfit::imager::testing::random_image;
using misfit::imager::testing::relative_error;
using Complex = std::complex<double>;

namespace {

/// Image sizes odd, even and thin, kernel widths odd and even.
const auto shapes = bdata::make({7, 8, 1, 20}) ^ bdata::make({5, 6, 11, 1}) ^ bdata::make({4, 5, 1, 3});

GridShape shape_of(int kernel_width) {
  return {24, 20, kernel_width, 8};
}

/// Corrections that differ everywhere, so that none can stand for another.
ImageCorrection correction(int width, int height) {
  ImageCorrection h;
  for (int c = 0; c < width; ++c) h.column.push_back(1 + 0.1 * c);
  for (int r = 0; r < height; ++r) h.row.push_back(2 - 0.07 * r);
  return h;
}

std::size_t index(const GridShape& s, int p, int q) {
  const int i = s.first_row(q) * s.columns() + s.first_column(p);
  return static_cast<std::size_t>(i);
}

/// Calls visit(p, q, index in the grid) for every cell that holds data, margins included.
template <typename Visit>
void for_each_cell(const GridShape& s, const Visit& visit) {
  for (int q = -s.margin(); q <= s.nv / 2 + s.margin() + 1; ++q)
    for (int p = -s.nu / 2 - s.margin(); p <= s.nu / 2 + s.margin() + 1; ++p) visit(p, q, index(s, p, q));
}

template <typename Real>
HalfGrid<Real> random_grid(const GridShape& shape) {
  std::mt19937_64 random(1);
  std::normal_distribution<Real> normal;
  HalfGrid<Real> grid(shape);
  for_each_cell(shape, [&](int, int, std::size_t i) {
    grid.real[i] = normal(random);
    grid.imaginary[i] = normal(random);
  });
  return grid;
}

/// exp(2πi(px/nu + qy/nv)) at an image's pixel.
Complex turn(const GridShape& s, const Image& image, int p, int q, int row, int column) {
  const int x = column - image.width / 2, y = row - image.height / 2;
  return std::polar(1.0, 2 * pi * (1.0 * p * x / s.nu + 1.0 * q * y / s.nv));
}

/// h(x) h(y) Re Σ G exp(+2πi(px/nu + qy/nv)).
template <typename Real>
Image plain_image(const HalfGrid<Real>& grid, const ImageCorrection& h) {
  Image image(static_cast<int>(h.column.size()), static_cast<int>(h.row.size()));
  for (int r = 0; r < image.height; ++r)
    for (int c = 0; c < image.width; ++c)
      for_each_cell(grid.shape, [&](int p, int q, std::size_t i) {
        image.at(r, c) += h.row[static_cast<std::size_t>(r)] * h.column[static_cast<std::size_t>(c)] *
                          std::real(Complex(grid.real[i], grid.imaginary[i]) * turn(grid.shape, image, p, q, r, c));
      });
  return image;
}

}  // namespace

BOOST_DATA_TEST_CASE(image_of_a_grid_equals_the_double_sum_over_its_cells_and_margins, shapes, width, height, kernel_width) {
  const HalfGrid<double> grid = random_grid<double>(shape_of(kernel_width));
  const ImageCorrection h = correction(width, height);
  const Image image = grid_to_image(grid.shape, grid.real, grid.imaginary, h, 2);
  // 1e-14: some ten rounded operations on each value.
  BOOST_TEST(relative_error(image.pixel, plain_image(grid, h).pixel) < 1e-14);
  const HalfGrid<float> coarse = random_grid<float>(shape_of(kernel_width));
  const Image single = grid_to_image(coarse.shape, coarse.real, coarse.imaginary, h, 2);
  BOOST_TEST(relative_error(single.pixel, plain_image(coarse, h).pixel) < 1e-6);
}

BOOST_DATA_TEST_CASE(a_grid_without_imaginary_part_is_real, shapes, width, height, kernel_width) {
  HalfGrid<double> grid = random_grid<double>(shape_of(kernel_width));
  const ImageCorrection h = correction(width, height);
  const Image image = grid_to_image<double>(grid.shape, grid.real, {}, h, 1);
  std::fill(grid.imaginary.begin(), grid.imaginary.end(), 0.0);
  BOOST_TEST(relative_error(image.pixel, plain_image(grid, h).pixel) < 1e-14);
}

BOOST_DATA_TEST_CASE(grid_of_an_image_equals_the_double_sum_over_its_pixels, shapes, width, height, kernel_width) {
  HalfGrid<double> grid(shape_of(kernel_width));
  const ImageCorrection h = correction(width, height);
  const Image image = random_image(width, height, 2);
  image_to_grid(image, h, 2, grid);
  std::vector<Complex> is, should;
  for_each_cell(grid.shape, [&](int p, int q, std::size_t i) {
    is.emplace_back(grid.real[i], grid.imaginary[i]);
    Complex sum = 0;
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c)
        sum += h.row[static_cast<std::size_t>(r)] * h.column[static_cast<std::size_t>(c)] * image.at(r, c) *
               std::conj(turn(grid.shape, image, p, q, r, c));
    should.push_back(sum);
  });
  BOOST_TEST(relative_error(is, should) < 1e-14);
}

BOOST_DATA_TEST_CASE(the_two_directions_are_adjoint, shapes, width, height, kernel_width) {
  const HalfGrid<double> x = random_grid<double>(shape_of(kernel_width));
  const Image y = random_image(width, height, 3);
  const ImageCorrection h = correction(width, height);
  const Image ax = grid_to_image(x.shape, x.real, x.imaginary, h, 1);
  HalfGrid<double> aty(x.shape);
  image_to_grid(y, h, 1, aty);
  double left = 0, right = 0;
  for (std::size_t i = 0; i < y.pixel.size(); ++i) left += ax.pixel[i] * y.pixel[i];
  for_each_cell(x.shape,
                [&](int, int, std::size_t i) { right += x.real[i] * aty.real[i] + x.imaginary[i] * aty.imaginary[i]; });
  BOOST_TEST(std::abs(left - right) < 1e-13 * norm(ax.pixel) * norm(y.pixel));
}

BOOST_AUTO_TEST_CASE(an_empty_grid_is_an_image_of_zeros) {
  const HalfGrid<double> grid(shape_of(5));
  const Image image = grid_to_image(grid.shape, grid.real, grid.imaginary, correction(9, 8), 2);
  BOOST_TEST(norm(image.pixel) == 0);
}

BOOST_AUTO_TEST_CASE(neither_direction_depends_on_the_number_of_threads) {
  const GridShape shape{100, 90, 6, 16};
  const HalfGrid<double> grid = random_grid<double>(shape);
  const ImageCorrection h = correction(70, 61);
  const Image input = random_image(70, 61, 4);
  const auto image = [&](int threads) { return grid_to_image(shape, grid.real, grid.imaginary, h, threads).pixel; };
  const auto gridded = [&](int threads) {
    HalfGrid<double> out(shape);
    image_to_grid(input, h, threads, out);
    return out.real;
  };
  BOOST_TEST((image(1) == image(5)));
  BOOST_TEST((gridded(1) == gridded(5)));
}

BOOST_AUTO_TEST_SUITE_END()
