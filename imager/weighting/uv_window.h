#pragma once

#include <limits>

namespace misfit::imager {

/// The ring of the uv plane that an image is made of, with edges that may be smooth. It multiplies the weight of a sample at
/// r = √(u² + v²), in wavelengths at the sample's own frequency, by
///   0                                    where r < min or r > max
///   T(r − min, inner) T(max − r, outer)  elsewhere, where T(x, d) = ½ (1 − cos(π x/d)) if x < d, else 1
/// T is the edge of a Tukey window: Harris 1978, On the use of windows for harmonic analysis with the discrete Fourier
/// transform (Proc. IEEE 66, 51). WSClean takes these factors at the cells of its grid of weights; here they are taken at the
/// sample itself.
struct UvWindow {
  double min_lambda = 0;
  double max_lambda = std::numeric_limits<double>::infinity();
  double inner_edge_lambda = 0;  ///< width d of the edge that begins at min; 0: steep
  double outer_edge_lambda = 0;  ///< width d of the edge that ends at max

  /// True if every factor is 1.
  bool is_whole_plane() const {
    return min_lambda == 0 && inner_edge_lambda == 0 && max_lambda == std::numeric_limits<double>::infinity();
  }
  double factor(double r_lambda) const;
};

}  // namespace misfit::imager
