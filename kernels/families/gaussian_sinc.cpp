#include <cmath>

#include "kernels/families/even_taps.h"
#include "kernels/families/families.h"
#include "kernels/families/sinc.h"

namespace misfit::kernels {
namespace {

/// AIPS's defaults of its exponential times sinc (help file UV4TYPE, parameters 2 and 3), there over 6 cells.
double gaussian_sinc(double u) {
  constexpr double sinc_scale = 1.55;
  constexpr double gaussian_scale = 2.52;
  return std::exp(-std::pow(u / gaussian_scale, 2)) * sinc(u / sinc_scale);
}

}  // namespace

KernelFamily gaussian_sinc_family() {
  return {"gaussian-sinc",
          "exp(−(u/2.52)²) sinc(u/1.55), AIPS's scales, cut off at 4 cells",
          8,
          8,
          0.01,
          0.49,
          [](int width, double x0) { return make_kernel("gaussian-sinc", x0, taps_over_cells(width, gaussian_sinc)); }};
}

}  // namespace misfit::kernels
