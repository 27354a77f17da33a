#include <cmath>

#include "kernels/families/even_taps.h"
#include "kernels/families/families.h"

namespace misfit::kernels {

KernelFamily gaussian_family() {
  return {"gaussian", "exp(−u²), cut off at 4 cells", 8, 8, 0.01, 0.49, [](int width, double x0) {
            return make_kernel("gaussian", x0, taps_over_cells(width, [](double u) { return std::exp(-u * u); }));
          }};
}

}  // namespace misfit::kernels
