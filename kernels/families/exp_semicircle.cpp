#include <cmath>

#include "kernels/families/even_taps.h"
#include "kernels/families/families.h"
#include "kernels/families/tuned.h"

namespace misfit::kernels {
namespace {

/// A. H. Barnett, J. Magland & L. af Klinteberg 2019, "A parallel nonuniform fast Fourier transform library based on an
/// 'exponential of semicircle' kernel", SIAM J. Sci. Comput. 41, C479.
TapFunction exp_semicircle_taps(int width, double beta) {
  return taps_over_support(width, [beta](double eta) { return std::exp(beta * (std::sqrt(1 - eta * eta) - 1)); });
}

}  // namespace

KernelFamily exp_semicircle_family() {
  return tuned_family("exp-semicircle", "exp(β (√(1 − η²) − 1)), β tuned for the smallest mean error", exp_semicircle_taps);
}

}  // namespace misfit::kernels
