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
  double noise_gain = 1;    ///< RMS over the pixels
  double largest_gain = 1;  ///< at the pixel where it is largest
};

inline constexpr int continuum = 128;  ///< fewer pixels give no mean over the field, and need no wide kernels

/// The misfit over the pixels of an image. For many pixels it is the kernel's own, over |x| ≤ x0, also where it was made for
/// another x0.
kernels::Misfit axis_misfit(const kernels::Kernel& kernel, int pixels, int fft_size);

/// The kernels of one family, of which each is made and judged once, when it is first asked for.
class KernelShelf {
 public:
  /// Where there is a `lookup`, kernels are judged by its tables.
  KernelShelf(kernels::KernelFamily family, const std::optional<kernels::TableOptions>& lookup);

  /// The kernel of `width` over `pixels` of an FFT of a given size.
  const AxisKernel& axis(int width, int pixels, int fft_size);
  /// The kernel of `width` over many pixels of an FFT of about this padding; or over planes.
  const AxisKernel& axis(int width, double padding);

 private:
  using Key = std::array<int, 3>;  ///< width, pixels and FFT size, or width, 0 and thousandths of the padding

  const AxisKernel& made(const Key& key, double x0, const std::function<kernels::Misfit(const kernels::Kernel&)>& misfit_of);

  kernels::KernelFamily family_;
  std::optional<kernels::TableOptions> lookup_;
  std::map<Key, AxisKernel> shelf_;
};

}  // namespace misfit::imager
