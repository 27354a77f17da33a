#pragma once

#include "imager/coplanar/coplanar_transform.h"

namespace misfit::imager {

/// The options of a WideTransform. The image is split into facets; each is a stack of w planes of its own. `nu` and `nv` are
/// the FFT lengths of a facet, and the kernels' x0 at least the largest facet's size / (2 · FFT size).
struct WideTransformOptions : CoplanarOptions {
  kernels::Kernel kernel_w;  ///< its x0 sets the distance of the planes: x0 / (largest |q| of the facet)
  int facets_l = 1;
  int facets_m = 1;
  std::size_t stack_bytes = std::size_t{1} << 30;      ///< memory for planes held at a time; at least one plane is held
  std::size_t samples_at_once = std::size_t{1} << 24;  ///< an adjoint is computed whenever so many have gathered

  bool has_w_axis() const { return kernel_w.width() > 0; }
};

/// The transform with its w axis, for any field of view: improved w-stacking (Ye, Gull, Tan & Nikolic 2022, MNRAS 510, 4110; as
/// in Arras et al. 2021, A&A 646, A58), facet by facet. Forward and adjoint are exact transposes of each other, and the result
/// does not depend on the number of threads. Throws std::invalid_argument when the options contradict each other.
std::unique_ptr<Transform> make_wide_transform(const WideTransformOptions& options);

/// The most bytes that a WideTransform takes for each of the samples that it orders at once, and for each further Stokes
/// parameter of these.
inline constexpr int wide_bytes_a_sample = 56, wide_bytes_a_value = 16;

/// The work of a WideTransform, as far as its memory depends on it.
struct WideDemand {
  double samples = 0;
  int planes = 1;  ///< of a facet at most
  int stokes = 1;  ///< images of an adjoint
};

TransformMemory memory_of(const WideTransformOptions& options, const WideDemand& demand);

/// longest_plane_sum() for the transform that make_transform makes.
double longest_sum(const WideTransformOptions& options, double samples);

/// The transform with its w axis where the options have one, else the transform in the plane.
std::unique_ptr<Transform> make_transform(const WideTransformOptions& options);

}  // namespace misfit::imager
