#include "imager/wide/facet.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cstdint>
#include <limits>

namespace misfit::imager {
namespace {

/// Calls visit(column, row) for the pixels above the horizon on a lattice of `most` steps along each side, or of all pixels,
/// the same from either end: one that is denser at one end tilts the plane.
template <typename Visit>
void for_lattice(const ImageGeometry& g, int most, const Visit& visit) {
  const int columns = std::min(g.width - 1, most), rows = std::min(g.height - 1, most);
  const auto from_end = [](std::int64_t i, int steps, int pixels) {
    return steps == 0 ? 0 : static_cast<int>(i * (pixels - 1) / steps);
  };
  const auto at = [&](int i, int steps, int pixels) {
    return 2 * i <= steps ? from_end(i, steps, pixels) : pixels - 1 - from_end(steps - i, steps, pixels);
  };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const int column = at(i, columns, g.width), row = at(j, rows, g.height);
      if (!beyond_horizon(g.at(row, column))) visit(column, row);
    }
}

/// The plane of least squares over a coarse lattice.
void fit_plane(Facet& f, int steps) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for_lattice(f.geometry, steps, [&](int column, int row) {
    const Eigen::Vector3d at(column - f.geometry.centre_column(), row - f.geometry.centre_row(), 1);
    normal += at * at.transpose();
    right += at * n_minus_1(f.geometry.at(row, column));
  });
  const Eigen::Vector3d plane = normal.completeOrthogonalDecomposition().solve(right);
  f.slope_l = -plane[0] / f.geometry.cell_rad;
  f.slope_m = plane[1] / f.geometry.cell_height_rad();
}

/// How far n − 1 strays from the plane.
void measure_reach(Facet& f, int steps) {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for_lattice(f.geometry, steps, [&](int column, int row) {
    const double q = f.curvature(column, row);
    lowest = std::min(lowest, q);
    highest = std::max(highest, q);
  });
  f.empty = lowest > highest;
  if (f.empty) return;
  constexpr double between = 1.002;  // the lattice's points: of 49 along a side, which miss up to 1/600 of what q spans
  f.middle = (lowest + highest) / 2;
  f.reach = between * (highest - lowest) / 2;
}

}  // namespace

std::vector<Facet> split_into_facets(const ImageGeometry& image, int along_l, int along_m) {
  std::vector<Facet> facets;
  const auto edge = [](int pixels, int parts, int i) { return static_cast<int>(static_cast<long long>(pixels) * i / parts); };
  for (int j = 0; j < along_m; ++j)
    for (int i = 0; i < along_l; ++i) {
      Facet f;
      f.geometry = image;
      f.first_column = edge(image.width, along_l, i);
      f.first_row = edge(image.height, along_m, j);
      f.geometry.width = edge(image.width, along_l, i + 1) - f.first_column;
      f.geometry.height = edge(image.height, along_m, j + 1) - f.first_row;
      f.geometry.centre = {image.l(f.first_column + f.geometry.width / 2), image.m(f.first_row + f.geometry.height / 2)};
      constexpr int lattice = 48;
      fit_plane(f, lattice);
      measure_reach(f, crosses_horizon(f.geometry) ? std::numeric_limits<int>::max() : lattice);
      facets.push_back(f);
    }
  return facets;
}

}  // namespace misfit::imager
