#pragma once

#include <vector>

#include "imager/data/geometry.h"

namespace misfit::imager {

/// A way to split an image into facets, and the turns of phase that each leaves to its w axis.
struct Faceting {
  int along_l = 1;
  int along_m = 1;
  int width = 0;  ///< pixels of the largest facet
  int height = 0;
  std::vector<double> turns;  ///< of each facet that reaches above the horizon: 2 · reach · largest |w|

  /// Planes of all facets together for planes 1/padding of a turn apart, of which a sample touches `width_w`; planes of w > 0
  /// count. At most 10⁹: no more could be computed.
  int planes(double padding_w, int width_w) const;
};

inline constexpr int most_facets = 32;

/// The ways worth considering, from the whole image as one facet on to `most` along its longer side: about square facets, none
/// smaller than 128 pixels, nor smaller than facets that leave hardly any phase to the w axis. Throws std::invalid_argument
/// when every pixel lies beyond the horizon.
std::vector<Faceting> facetings(const ImageGeometry& image, double max_abs_w, int most = most_facets);

}  // namespace misfit::imager
