#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>

#include "kernels/catalogue.h"
#include "kernels/lookup_table.h"

namespace misfit::imager {

/// One axis of the transform: a kernel over the pixels of an image.
struct AxisKernel {
  kernels::Kernel kernel;
  kernels::Misfit misfit;   ///< over this image's pixels
  double noise_gain = 1;    ///< RMS over them
  double largest_gain = 1;  ///< at the one where it is largest
};

inline constexpr int continuum = 128;  ///< fewer pixels are no mean over the field, and need no wide kernels

/// Over the pixels of an image. Over many the kernel's own means over |x| ≤ x0 serve, as they do where it was made for another
/// x0.
kernels::Misfit axis_misfit(const kernels::Kernel& kernel, int pixels, int fft_size);

/// The kernels of one family, of which each is made and judged once, when it is first asked for.
class KernelShelf {
 public:
  /// Where there is a `lookup`, kernels are judged as its tables give them.
  KernelShelf(kernels::KernelFamily family, const std::optional<kernels::TableOptions>& lookup);

  /// Over `pixels` of an FFT of a given size.
  const AxisKernel& axis(int width, int pixels, int fft_size);
  /// Over many pixels of an FFT of about this padding; over planes.
  const AxisKernel& axis(int width, double padding);

 private:
  using Key = std::array<int, 3>;  ///< width, pixels and FFT size, or width, 0 and thousandths of the padding

  const AxisKernel& made(const Key& key, double x0, const std::function<kernels::Misfit(const kernels::Kernel&)>& misfit_of);

  kernels::KernelFamily family_;
  std::optional<kernels::TableOptions> lookup_;
  std::map<Key, AxisKernel> shelf_;
};

}  // namespace misfit::imager
