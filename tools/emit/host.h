#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kernels/kernel.h"
#include "kernels/map_error.h"

namespace misfit::tools {

/// A gridding function as a host will have it.
struct HostKernel {
  kernels::Kernel kernel;
  int per_cell = 0;       ///< Ms, entries a cell; 0 where the host evaluates polynomials
  int interpolation = 0;  ///< degree of the polynomial through entries next to each other; 0 = the nearest entry
  double padding = 2;     ///< FFT size over image size that the host will use
  int image_size = 1024;  ///< pixels along an axis, without padding; some hosts' corrections depend on it

  double x0() const { return 0.5 / padding; }  ///< half of the FFT image that the host keeps
};

/// A host's taps and correction, by its published rule.
struct HostRule {
  kernels::TapFunction taps;
  int steps_per_cell = 0;          ///< as in kernels::JudgeOptions
  kernels::Correction correction;  ///< h that the image is multiplied by; empty = the optimal one for these taps
};

/// How many entries a cell a host's tables may have.
struct TableSizes {
  int usual = 0;  ///< what is emitted when nothing is said; 0 = the host has no table
  int most = 0;
  bool odd = false;           ///< whether it must be an odd number
  bool interpolated = false;  ///< whether values between entries can be had by polynomials
};

struct Emission;

/// Another imager into which a gridding function can be put. A new one is a file beside those there are, and a line in
/// hosts.cpp.
struct Host {
  std::string name;               ///< as given to --emit
  std::string title;              ///< a line's beginning: "casacore's ConvolveGridder"
  std::string habit;              ///< how it evaluates, normalises and corrects, in a line
  std::optional<double> padding;  ///< that it uses unless it is told otherwise
  double min_padding = 1;
  double max_padding = 500;
  int min_width = 1;
  int max_width = 20;
  TableSizes table;
  int bits = 53;                   ///< of the mantissa of what it sums up
  bool depends_on_pixels = false;  ///< whether its own correction depends on the image's size
  /// Lowest and highest degree of the polynomials that it holds for a width; not used for hosts with tables.
  std::function<std::pair<int, int>(int width)> degrees;
  std::function<int(int width)> taps_of;           ///< cells that it touches an axis for a kernel of this width
  std::function<double(const HostKernel&)> bytes;  ///< of its tables; empty for hosts with polynomials
  /// The taps that it makes of the kernel.
  std::function<kernels::TapFunction(const HostKernel&)> taps;
  /// The correction that it works out by itself from what it is given; empty where it must be given one.
  std::function<kernels::Correction(const HostKernel&)> own_correction;
  /// The correction that its file gives it; empty = the optimal one.
  std::function<kernels::Correction(const HostKernel&)> given_correction;
  /// Its rule with its own function, at this padding and image size; empty where that is not known.
  std::function<HostRule(const HostKernel&)> stock;
  std::string otherwise;   ///< how to have more than the host can do, to end a refusal; may be empty
  std::string stock_name;  ///< its own function: "its spheroidal function, 100 entries a cell"
  /// Writes the file; it appears under its name only when complete.
  std::function<void(const Emission&, const std::string& path)> write;
};

/// Every host there is. A new one is a line in hosts.cpp.
const std::vector<Host>& host_catalogue();

/// The names of all hosts.
std::vector<std::string> host_names();

/// The host called `name`; for any other name std::invalid_argument lists those there are.
const Host& find_host(const std::string& name);

}  // namespace misfit::tools
