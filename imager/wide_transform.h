#pragma once

#include "imager/plane_transform.h"

namespace misfit::imager {

/// What a WideTransform is made of. The image is split into facets; each is a stack of w planes of its own.
struct WideTransformOptions {
  ImageGeometry geometry;
  int facets_l = 1;
  int facets_m = 1;
  int nu = 0;  ///< FFT lengths of a facet, at least the largest facet's size
  int nv = 0;
  kernels::Kernel kernel_u;  ///< one width with kernel_v; x0 at least facet size / (2 · FFT size)
  kernels::Kernel kernel_v;
  kernels::Kernel kernel_w;  ///< its x0 sets the distance of the planes: x0 / (largest |q| of the facet)
  Precision precision = Precision::double_precision;
  int threads = 1;
  std::size_t stack_bytes = std::size_t{1} << 30;      ///< memory for planes held at a time; at least one plane is
  std::size_t samples_at_once = std::size_t{1} << 26;  ///< an adjoint is computed whenever so many have gathered
};

/// The transform with its w axis, for any field of view: improved w-stacking (Ye, Gull, Tan & Nikolic 2022, MNRAS 510, 4110; as
/// in Arras et al. 2021, A&A 646, A58), facet by facet. Forward and adjoint are exact transposes of each other, and the result
/// does not depend on the number of threads. Pixels beyond the horizon are NaN in images and unused in prediction. Throws
/// std::invalid_argument when the options contradict each other.
std::unique_ptr<Transform> make_wide_transform(const WideTransformOptions& options);

}  // namespace misfit::imager
