#include "kernels/minimax.h"

#include "kernels/families/families.h"

namespace misfit::kernels {

KernelFamily minimax_family() {
  return {"minimax",
          "smallest error at the worst pixel of the image for its width and x0",
          1,
          least_misfit_max_width,
          least_misfit_min_x0,
          least_misfit_max_x0,
          [](int width, double x0) { return store("minimax", solve_minimax(width, x0)); },
          true};
}

}  // namespace misfit::kernels
