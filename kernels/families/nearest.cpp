#include "kernels/families/families.h"

namespace misfit::kernels {

KernelFamily nearest_family() {
  return {"nearest", "each visibility to its nearest cell, C(u) = 1", 1, 1, 0.01, 0.49, [](int, double x0) {
            return make_kernel("nearest", x0, [](double) -> Eigen::VectorXd { return Eigen::VectorXd::Ones(1); });
          }};
}

}  // namespace misfit::kernels
