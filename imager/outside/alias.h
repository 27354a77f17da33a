#pragma once

#include "imager/wide/wide_transform.h"

namespace misfit::imager {

/// The largest pixel that the alias of a source of 1 Jy at `source`, outside the image, may have in Jy/beam. A kernel with the
/// taper c and correction h turns a source at X (the offset from the middle of the facet over the size of the FFT) into copies
/// at X − n along each axis, n whole: by Poisson's sum, h(x) Σ_r C(r−ν) exp(2πi(r−ν)x) = Σ_n h(x) c(x+n) exp(2πinν). The copy
/// that falls upon the facet has the height h(X−n) c(X), along u times along v; one that falls into the padding leaves its
/// sidelobes alone, at most `max_sidelobe` of what it would have at the facet's nearest pixel. Where all n are 0 there is no
/// alias. A w axis blurs the copy, since n − 1 is another where the source is: what it would be without that is an upper bound.
/// Of several facets the worst counts.
double alias_level(const WideTransformOptions& options, DirectionCosines source, double max_sidelobe);

}  // namespace misfit::imager
