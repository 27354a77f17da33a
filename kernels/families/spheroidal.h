#pragma once

#include "kernels/kernel.h"

namespace misfit::kernels {

/// The prolate spheroidal function ψ of order α = 1, times 1 − η², over a width of W = m = 4…8 cells, by Schwab's rational
/// approximations (F. R. Schwab 1984, "Optimal gridding of visibility data in radio interferometry", in Indirect Imaging, ed.
/// J. A. Roberts, Cambridge University Press, p. 333; coefficients good to about 7 digits). The gridding function of AIPS and
/// CASA for W = 6. Throws std::invalid_argument for other widths.
TapFunction spheroidal_taps(int width);

}  // namespace misfit::kernels
