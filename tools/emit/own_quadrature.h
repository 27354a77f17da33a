#pragma once

#include "kernels/map_error.h"

namespace misfit::tools {

/// 1/c(x) with c(x) = ∫ C(u) cos(2πux) du by Gauss–Legendre nodes over the whole support, 2·`half` of them, as hosts do that
/// take C for smooth. Where C jumps between cells, it is not the taper.
kernels::Correction whole_support_correction(const kernels::PiecewisePolynomial& function, int half);

}  // namespace misfit::tools
