#pragma once

#include "kernels/catalogue.h"
#include "tools/emit/emission.h"

namespace misfit::tools {

/// The needs that a kernel for a host is chosen by.
struct HostRequest {
  const Host* host = nullptr;
  kernels::KernelFamily family;
  double target_error = 1e-6;  ///< RMS, as RealisedError::rms
  double padding = 2;          ///< FFT size over image size that the host will use
  int interpolation = 0;
  int image_size = 1024;
};

/// The function with the fewest taps an axis whose realised error, with the divisor of the file, is at most the target, with
/// the lowest degree or the fewest entries; a width for which ten times as many entries are needed as for the next is passed
/// over. Throws std::invalid_argument that says what the host can reach when it is less.
HostKernel choose_for_host(const HostRequest& request);

}  // namespace misfit::tools
