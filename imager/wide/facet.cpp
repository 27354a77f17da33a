#include "imager/wide/facet.h"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

namespace misfit::imager {
namespace {

/// Calls visit(column, row) for the pixels above the horizon on a lattice of every `step`-th pixel and the last.
template <typename Visit>
void for_lattice(const ImageGeometry& g, int step, const Visit& visit) {
  const auto next = [step](int i, int last) { return i == last ? last + 1 : std::min(i + step, last); };
  for (int row = 0; row < g.height; row = next(row, g.height - 1))
    for (int column = 0; column < g.width; column = next(column, g.width - 1))
      if (!beyond_horizon(g.at(row, column))) visit(column, row);
}

/// The plane of least squares over a coarse lattice.
void fit_plane(Facet& f, int step) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for_lattice(f.geometry, step, [&](int column, int row) {
    const Eigen::Vector3d at(column - f.geometry.centre_column(), row - f.geometry.centre_row(), 1);
    normal += at * at.transpose();
    right += at * n_minus_1(f.geometry.at(row, column));
  });
  const Eigen::Vector3d plane = normal.completeOrthogonalDecomposition().solve(right);
  f.slope_l = -plane[0] / f.geometry.cell_rad;
  f.slope_m = plane[1] / f.geometry.cell_rad;
}

/// How far n − 1 strays from the plane.
void measure_reach(Facet& f, int step) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for_lattice(f.geometry, step, [&](int column, int row) {
    const double q = f.curvature(column, row);
    least = std::min(least, q);
    most = std::max(most, q);
  });
  f.empty = least > most;
  if (f.empty) return;
  constexpr double between = 1.002;  // the lattice's points
  f.middle = (least + most) / 2;
  f.reach = between * (most - least) / 2;
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
      constexpr int lattice = 32;
      const int step = std::max(1, std::max(f.geometry.width, f.geometry.height) / lattice);
      fit_plane(f, step);
      measure_reach(f, crosses_horizon(f.geometry) ? 1 : step);
      facets.push_back(f);
    }
  return facets;
}

}  // namespace misfit::imager
