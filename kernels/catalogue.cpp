#include "kernels/catalogue.h"

#include <stdexcept>

#include "kernels/least_misfit.h"
#include "kernels/spheroidal.h"

namespace misfit::kernels {

const std::vector<KernelFamily>& kernel_catalogue() {
  static const std::vector<KernelFamily> families{
      {"least-misfit", 1, least_misfit_max_width, least_misfit_min_x0, least_misfit_max_x0, least_misfit_up_to},
      {"spheroidal", 4, 8, 0.05, 0.49, spheroidal_up_to},
  };
  return families;
}

const KernelFamily& kernel_family(const std::string& name) {
  std::string known;
  for (const KernelFamily& family : kernel_catalogue()) {
    if (family.name == name) return family;
    known += (known.empty() ? "" : ", ") + family.name;
  }
  throw std::invalid_argument("kernel \"" + name + "\" is not known; expected one of: " + known);
}

}  // namespace misfit::kernels
