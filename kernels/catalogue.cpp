#include "kernels/catalogue.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "kernels/catalogue_internal.h"
#include "kernels/families/families.h"
#include "kernels/text_internal.h"

namespace misfit::kernels {

void KernelFamily::require_width(int width) const {
  if (width < min_width || width > max_width)
    throw std::invalid_argument("kernel " + name + ": width " + std::to_string(width) + ", expected " +
                                std::to_string(min_width) + " to " + std::to_string(max_width));
}

void KernelFamily::require_x0(double x0) const {
  if (!(x0 >= min_x0 && x0 <= max_x0))
    throw std::invalid_argument("kernel " + name + ": x0 = " + text_of(x0) + ", expected " + text_of(min_x0) + " to " +
                                text_of(max_x0));
}

Kernel KernelFamily::make(int width, double x0) const {
  require_width(width);
  require_x0(x0);
  return solve(width, x0);
}

std::vector<KernelFamily>& changeable_catalogue() {
  static std::vector<KernelFamily> families{
      least_misfit_family(),  minimax_family(),       spheroidal_family(1),    spheroidal_family(0),
      spheroidal_family(0.5), spheroidal_family(1.5), spheroidal_family(2),    spheroidal_exact_family(),
      prolate_family(),       kaiser_bessel_family(), exp_semicircle_family(), nearest_family(),
      linear_family(),        sinc_family(),          gaussian_family(),       gaussian_sinc_family(),
  };
  return families;
}

const std::vector<KernelFamily>& kernel_catalogue() {
  return changeable_catalogue();
}

KernelFamily kernel_family(const std::string& name) {
  std::string known;
  for (const KernelFamily& family : kernel_catalogue()) {
    if (family.name == name) return family;
    known += (known.empty() ? "" : ", ") + family.name;
  }
  if (const std::optional<KernelFamily> family = spheroidal_exact_family(name)) return *family;
  throw std::invalid_argument("kernel \"" + name + "\" is not known; expected one of: " + known + ", spheroidal-exact-<order>");
}

KernelFamily family_of(const Kernel& kernel) {
  constexpr double least_x0 = 1e-3;  // less than images have, which are padded to 80 pixels at most
  const auto judged = [kernel](int, double x0) {
    Kernel same = kernel;
    if (x0 == kernel.x0) return same;
    same.x0 = x0;
    same.misfit = judge(kernel.polynomial, x0);
    same.origin.mean_error = same.misfit.mean;
    same.origin.max_error = same.misfit.max;
    same.origin.max_error_bound = same.origin.condition = std::numeric_limits<double>::quiet_NaN();
    return same;
  };
  return {kernel.name, "one kernel", kernel.width(), kernel.width(), std::min(least_x0, kernel.x0), kernel.x0, judged};
}

}  // namespace misfit::kernels
