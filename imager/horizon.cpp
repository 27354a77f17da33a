#include "imager/horizon.h"

#include <limits>

namespace misfit::imager {

void blank_beyond_horizon(const ImageGeometry& g, Image& image) {
  if (!crosses_horizon(g)) return;
  for (int row = 0; row < g.height; ++row)
    for (int column = 0; column < g.width; ++column)
      if (beyond_horizon(g.at(row, column))) image.at(row, column) = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace misfit::imager
