#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kernels/kernel.h"

namespace misfit::kernels {

/// A family of gridding functions: one kernel for each width and retained fraction.
struct KernelFamily {
  std::string name;
  int min_width = 1;
  int max_width = 1;
  double min_x0 = 0;
  double max_x0 = 0.5;
  /// The kernels of widths min_width … `width`, narrowest first: some solvers find the narrower on their way to the wider.
  std::function<std::vector<Kernel>(int width, double x0)> make_up_to;

  Kernel make(int width, double x0) const { return make_up_to(width, x0).back(); }
};

/// Every family there is. A new one is a line here.
const std::vector<KernelFamily>& kernel_catalogue();

/// The family called `name`; std::invalid_argument lists the names for any other.
const KernelFamily& kernel_family(const std::string& name);

}  // namespace misfit::kernels
