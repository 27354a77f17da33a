#include "imager/horizon.h"

#include <cmath>
#include <limits>

namespace misfit::imager {
namespace {

bool beyond(const ImageGeometry& g, int column, int row) {
  return std::isnan(n_minus_1({g.l(column), g.m(row)}));
}

}  // namespace

bool crosses_horizon(const ImageGeometry& g) {
  const int right = g.width - 1, top = g.height - 1;
  return beyond(g, 0, 0) || beyond(g, 0, top) || beyond(g, right, 0) || beyond(g, right, top);
}

void blank_beyond_horizon(const ImageGeometry& g, Image& image) {
  if (!crosses_horizon(g)) return;
  for (int row = 0; row < g.height; ++row)
    for (int column = 0; column < g.width; ++column)
      if (beyond(g, column, row)) image.at(row, column) = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace misfit::imager
