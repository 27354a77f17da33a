#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kernels/kernel.h"

namespace misfit::kernels {

/// A family of gridding functions: one kernel for each width and retained fraction.
struct KernelFamily {
  std::string name;
  std::string description;  ///< a line for a person who chooses
  int min_width = 1;
  int max_width = 1;
  double min_x0 = 0.01;
  double max_x0 = 0.49;
  std::function<Kernel(int width, double x0)> solve;  ///< for arguments in these ranges
  bool costly = false;                                ///< solving takes longer than reading the solution from a file

  /// These throw std::invalid_argument that names the argument outside its range.
  void require_width(int width) const;
  void require_x0(double x0) const;
  /// The kernel of `width` for `x0`. Throws what require_width() and require_x0() do.
  Kernel make(int width, double x0) const;
};

/// Every family there is. A new one is a line here.
const std::vector<KernelFamily>& kernel_catalogue();

/// The family called `name`: one of the catalogue, or spheroidal-exact-<α> for any order α from 0 to 10. For any other name
/// std::invalid_argument lists those there are.
KernelFamily kernel_family(const std::string& name);

/// The family that holds `kernel` alone, for its width and any x0 up to its own. Its errors are judged anew over a smaller x0,
/// and the facts about the optimum at its own x0 are dropped.
KernelFamily family_of(const Kernel& kernel);

}  // namespace misfit::kernels
