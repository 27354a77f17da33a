#pragma once

#include "kernels/catalogue.h"
#include "tools/emit/emission.h"

namespace misfit::tools {

/// The request of --emit and the options beside it.
struct EmitOptions {
  std::string host;
  double host_padding = 0;  ///< 0 = the host's own, or that of the kernel
  double target_error = 0;  ///< 0 = width and sampling are given
  bool force = false;       ///< emit a kernel that is made for another padding, too
  int image_size = 1024;

  int width = 0;           ///< 0 = the only one of the family, or the target's
  double x0 = 0;           ///< 0 = the host's
  int degree = -1;         ///< −1 = as many terms as the kernel and the host have
  int per_cell = 0;        ///< 0 = the host's usual number
  int interpolation = -1;  ///< −1 = the nearest entry, or cubic where a host interpolates
};

/// The emission to write; std::invalid_argument names the option that cannot be meant, or what the host cannot do.
Emission plan_emission(const EmitOptions& options, const kernels::KernelFamily& family);

}  // namespace misfit::tools
