#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "kernels/catalogue.h"
#include "kernels/kernel_table.h"
#include "tests/temporary_folder.h"

namespace misfit::testing {

/// Solved once.
inline const kernels::Kernel& least_misfit(int width, double x0) {
  static std::map<std::pair<int, double>, kernels::Kernel> solved;
  const auto found = solved.find({width, x0});
  if (found != solved.end()) return found->second;
  return solved.emplace(std::pair{width, x0}, kernels::kernel_family("least-misfit").make(width, x0)).first->second;
}

/// A least-misfit function as a file.
struct LeastMisfitFile {
  LeastMisfitFile(int width, double x0, const std::optional<kernels::TableSampling>& sampling = {})
      : kernel(least_misfit(width, x0)) {
    kernels::write_kernel_table(kernel, sampling, path);
  }
  TemporaryFolder folder;
  std::string path = folder / "k.fits";
  const kernels::Kernel& kernel;
};

/// How large an image and its FFT are.
struct Size {
  int pixels;
  int fft;
  double x0() const { return pixels / (2.0 * fft); }
};
inline constexpr Size padded_twice{64, 128}, padded_little{120, 144};  ///< by 2 and 1.2

}  // namespace misfit::testing
