#pragma once

#include "kernels/kernel.h"

namespace misfit::kernels {

/// The spheroidal gridding function (1 − η²)^α ψ(η), η = 2u/W, of bandwidth c = πW/2, by Schwab's rational approximations for
/// widths W = m = 4…8 and orders α = 0, ½, 1, 1½, 2 (F. R. Schwab 1984, "Optimal gridding of visibility data in radio
/// interferometry", in Indirect Imaging, ed. J. A. Roberts, Cambridge University Press, p. 333; coefficients good to about 7
/// digits). With α = 1 and W = 6 the gridding function of AIPS and CASA. Throws std::invalid_argument for any other width or
/// order. spheroidal_exact.h has the function itself.
TapFunction spheroidal_taps(int width, double alpha = 1);

}  // namespace misfit::kernels
