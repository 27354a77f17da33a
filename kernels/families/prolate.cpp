#include "kernels/families/families.h"
#include "kernels/families/spheroidal_exact.h"
#include "kernels/families/tuned.h"

namespace misfit::kernels {

KernelFamily prolate_family() {
  return tuned_family("prolate", "the prolate function of order 0, its bandwidth tuned for the smallest mean error",
                      [](int width, double bandwidth) { return spheroidal_exact_taps(width, 0, bandwidth); });
}

}  // namespace misfit::kernels
