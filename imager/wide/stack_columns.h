#pragma once

#include "imager/data/image.h"
#include "imager/wide/column_group.h"
#include "imager/wide/image_planes.h"

namespace misfit::imager {

/// The FFTs along v of planes whose rows have been transformed (StackRows), and the step between planes and images:
///   image_i(x, y) += h_u h_v h_w Re Σ_k Σ_{p,q} G_{k,i}(p, q) exp(+2πi(px/nu + qy/nv + w_k q_w(x, y))),
/// w_k = (first_plane + k + ½) plane_step, for the i-th grid of every plane in the upper half of the planes, k = 0 being the
/// first of these; q_w is the facet's curvature. Pixels beyond the horizon become NaN.
template <typename Real>
void planes_to_images(const ImagePlanes<Real>& planes, const StackedFacet& facet, int first_plane, int threads,
                      const std::vector<Image*>& images);

/// The adjoint of planes_to_images(), for planes of one grid whose rows are still to be transformed. Pixels beyond the horizon
/// are not used.
template <typename Real>
void image_to_planes(const Image& image, const StackedFacet& facet, int first_plane, int threads, ImagePlanes<Real>& planes);

}  // namespace misfit::imager
