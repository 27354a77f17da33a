#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace misfit::tools::testing {

/// A cell of the grid and the tap that it takes.
using Tap = std::pair<long, double>;

/// A host as its authors publish it, with what it finds in a file that --emit wrote.
struct EmulatedHost {
  std::function<std::vector<Tap>(double u)> taps;                ///< of a visibility at u, in cells
  std::function<double(long pixel, long fft_size)> divisor;      ///< pixel from the image's centre
  std::function<double(long pixel, long fft_size)> own_divisor;  ///< that the host works out itself, where it does
};

/// `host` as given to --emit, all but casacore, which is here itself.
EmulatedHost emulated_host(const std::string& host, const std::string& file_content);

/// RMS of visibilities predicted by the host, relative to the exact ones, for an image of `pixels` squared whose pixels have
/// random phases.
double measured_error(const EmulatedHost& host, bool own_divisor, int pixels, int fft_size);

}  // namespace misfit::tools::testing
