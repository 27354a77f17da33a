#include "imager/data/horizon.h"

namespace misfit::imager {

void set_beyond_horizon(const ImageGeometry& g, double value, Image& image) {
  if (!crosses_horizon(g)) return;
  for (int row = 0; row < g.height; ++row)
    for (int column = 0; column < g.width; ++column)
      if (beyond_horizon(g.at(row, column))) image.at(row, column) = value;
}

}  // namespace misfit::imager
