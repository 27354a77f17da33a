#pragma once

#include <vector>

#include "imager/data/geometry.h"

namespace misfit::imager {

/// A rectangle of an image, and the plane that lies closest to n − 1 over it. With dl, dm counted from its middle pixel,
///   ul + vm + w(n−1) = (u + slope_l w) dl + (v + slope_m w) dm + w q(l, m) + [u l_0 + v m_0 + w middle],   |q| ≤ reach.
/// The bracket is a phase of the sample alone; the plane is a shear of its coordinates (Kogan & Greisen 2009 do so per facet,
/// and neglect q). What is left for the w axis, q, falls with the square of the facet's size.
struct Facet {
  ImageGeometry geometry;  ///< its own pixels; `centre` is l_0, m_0
  int first_column = 0;    ///< in the whole image
  int first_row = 0;
  double slope_l = 0;
  double slope_m = 0;
  double middle = 0;
  double reach = 0;    ///< largest |q| over the pixels above the horizon
  bool empty = false;  ///< every pixel lies beyond the horizon

  /// q at a pixel; NaN beyond the horizon.
  double curvature(int column, int row) const {
    const double l = geometry.l(column), m = geometry.m(row);
    return n_minus_1({l, m}) - slope_l * (l - geometry.centre.l) - slope_m * (m - geometry.centre.m) - middle;
  }
};

/// Splits an image into `along_l` × `along_m` facets whose sizes differ by a pixel at most.
std::vector<Facet> split_into_facets(const ImageGeometry& image, int along_l, int along_m);

/// The pixels along an axis of the largest of `facets` facets.
inline int largest_facet(int pixels, int facets) {
  return (pixels + facets - 1) / facets;
}

}  // namespace misfit::imager
