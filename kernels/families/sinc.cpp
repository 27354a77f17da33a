#include "kernels/families/sinc.h"

#include "kernels/families/even_taps.h"
#include "kernels/families/families.h"

namespace misfit::kernels {

KernelFamily sinc_family() {
  return {"sinc", "the interpolating sinc(u), cut off at 4 cells", 8, 8, 0.01, 0.49, [](int width, double x0) {
            return make_kernel("sinc", x0, taps_over_cells(width, sinc));
          }};
}

}  // namespace misfit::kernels
