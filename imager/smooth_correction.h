#pragma once

#include <vector>

#include "kernels/kernel.h"

namespace misfit::imager {

/// The optimal correction h(x) of a kernel at any |x| ≤ x0, as a Chebyshev series in x²: quick where every pixel has an x of
/// its own. True to the rounding of doubles, slightly beyond x0 too.
class SmoothCorrection {
 public:
  explicit SmoothCorrection(const kernels::Kernel& kernel);
  double operator()(double x) const {
    const double z = scale_ * x * x - 1;
    double last = 0, before = 0;
    for (std::size_t k = coefficient_.size(); k-- > 1;) {
      const double now = 2 * z * last - before + coefficient_[k];
      before = last;
      last = now;
    }
    return z * last - before + coefficient_[0];
  }

 private:
  double scale_;
  std::vector<double> coefficient_;
};

}  // namespace misfit::imager
