#include "imager/outside/alias.h"

#include <algorithm>
#include <cmath>

#include "imager/wide/facet.h"

namespace misfit::imager {
namespace {

/// The copy of a source along one axis of a facet.
struct Copy {
  double height = 0;     ///< |h(X − n) c(X)|
  bool shifted = false;  ///< n is not 0
  bool within = false;   ///< it falls upon the facet's pixels
};

/// Of a source `offset` pixels from the middle one of `pixels`.
Copy nearest_copy(const kernels::Kernel& kernel, double offset, int pixels, int fft_size) {
  const double n = std::round(offset / fft_size);
  const double at = offset - n * fft_size;
  const double first = -(pixels / 2), last = (pixels - 1) / 2;
  const double nearest = std::clamp(at, first, last);
  Copy copy;
  copy.shifted = n != 0;
  copy.within = std::abs(at - nearest) < 1;  // the pixel beside shows almost all of it
  const auto single = [](double x) { return Eigen::VectorXd::Constant(1, x); };
  const double h = kernels::optimal_correction(kernel.polynomial, single(nearest / fft_size))[0];
  copy.height = std::abs(h * kernels::image_taper(kernel.polynomial, single(nearest / fft_size + n))[0]);
  return copy;
}

}  // namespace

double alias_level(const WideTransformOptions& o, DirectionCosines source, double max_sidelobe) {
  double worst = 0;
  const bool wide = o.has_w_axis();
  for (const Facet& facet : split_into_facets(o.geometry, wide ? o.facets_l : 1, wide ? o.facets_m : 1)) {
    const ImageGeometry& g = facet.geometry;
    const Copy u = nearest_copy(o.kernel_u, (g.centre.l - source.l) / g.cell_rad, g.width, o.nu);
    const Copy v = nearest_copy(o.kernel_v, (source.m - g.centre.m) / g.cell_rad, g.height, o.nv);
    if (!u.shifted && !v.shifted) continue;
    worst = std::max(worst, u.height * v.height * (u.within && v.within ? 1 : max_sidelobe));
  }
  return worst;
}

}  // namespace misfit::imager
