#include "kernels/families/even_taps.h"
#include "kernels/families/families.h"

namespace misfit::kernels {

KernelFamily linear_family() {
  return {"linear", "linear interpolation, C(u) = 1 − |u|", 2, 2, 0.01, 0.49, [](int width, double x0) {
            return make_kernel("linear", x0, taps_over_cells(width, [](double u) { return 1 - u; }));
          }};
}

}  // namespace misfit::kernels
