#include "imager/plan/axis_kernel.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/evaluation.h"

namespace misfit::imager {
namespace {

/// Over more pixels it does not matter that the first lies at −x0, and the last one pixel short of x0.
constexpr int countable = 1024;

}  // namespace

kernels::Misfit axis_misfit(const kernels::Kernel& kernel, int pixels, int fft_size) {
  const bool made_for_them = kernel.x0 == 0.5 * pixels / fft_size;
  const bool counted = pixels < continuum || (made_for_them && pixels < countable);
  return counted ? kernels::judge_pixels(kernel.polynomial, pixels, fft_size) : kernel.misfit;
}

KernelShelf::KernelShelf(kernels::KernelFamily family, const std::optional<kernels::TableOptions>& lookup)
    : family_(std::move(family)), lookup_(lookup) {}

const AxisKernel& KernelShelf::axis(int width, int pixels, int fft_size) {
  return made({width, pixels, fft_size}, 0.5 * pixels / fft_size,
              [&](const kernels::Kernel& kernel) { return axis_misfit(kernel, pixels, fft_size); });
}

const AxisKernel& KernelShelf::axis(int width, double padding) {
  const int thousandths = static_cast<int>(std::floor(1000 * padding));
  return made({width, 0, thousandths}, 500.0 / thousandths, [](const kernels::Kernel& kernel) { return kernel.misfit; });
}

const AxisKernel& KernelShelf::made(const Key& key, double x0,
                                    const std::function<kernels::Misfit(const kernels::Kernel&)>& misfit_of) {
  const auto found = shelf_.find(key);
  if (found != shelf_.end()) return found->second;
  AxisKernel axis{family_.make(key[0], std::clamp(x0, family_.min_x0, family_.max_x0)), {}};
  axis.misfit = misfit_of(axis.kernel);
  if (lookup_) axis.misfit = kernels::judge_table(axis.kernel.polynomial, axis.misfit, *lookup_, x0);
  axis.noise_gain = kernels::noise_gain(axis.kernel.polynomial, axis.kernel.x0);
  axis.largest_gain = kernels::largest_noise_gain(axis.kernel.polynomial, axis.kernel.x0);
  return shelf_.emplace(key, axis).first->second;
}

}  // namespace misfit::imager
