#include "kernels/least_misfit.h"

#include "kernels/families/families.h"

namespace misfit::kernels {

KernelFamily least_misfit_family() {
  return {"least-misfit",
          "smallest mean error over the image for its width and x0",
          1,
          least_misfit_max_width,
          least_misfit_min_x0,
          least_misfit_max_x0,
          [](int width, double x0) { return store("least-misfit", solve_least_misfit(width, x0)); },
          true};
}

}  // namespace misfit::kernels
