#include <cmath>
#include <numbers>

#include "kernels/sampled_function.h"
#include "tools/base/files.h"
#include "tools/base/numbers.h"
#include "tools/emit/c_source.h"
#include "tools/emit/hosts.h"

namespace misfit::tools {
namespace {

/// Cells of WSClean's -kernel-size: an odd number, the kernel's width or the next one.
int taps_of(int width) {
  return width % 2 == 1 ? width : width + 1;
}

/// 1/ĉ half a pixel off: WSClean 3.1 divides by FFTW's REDFT01 of the table, Σ_i C(i/Ms) cos(2π (k + ½) i / (N Ms)) at the
/// pixel k = 0, 1 … from the centre of an FFT of N pixels, which is ĉ at x = (k + ½)/N.
kernels::Correction dct_correction(const Eigen::VectorXd& table, const HostKernel& k) {
  const double half_pixel = 0.5 / std::round(k.image_size * k.padding);
  return [table, per_cell = k.per_cell, half_pixel](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    Eigen::VectorXd taper = Eigen::VectorXd::Constant(x.size(), table[0]);
    const Eigen::ArrayXd phase = 2 * std::numbers::pi * (x.array().abs() + half_pixel) / per_cell;
    for (Eigen::Index i = 1; i < table.size(); ++i) taper += 2 * table[i] * (static_cast<double>(i) * phase).cos().matrix();
    return per_cell * taper.cwiseInverse();
  };
}

/// WSClean's default: a Kaiser–Bessel function of α = 8.6 times a sinc, over 7 cells, 1023 entries each.
HostRule stock_of_wsclean(const HostKernel& asked) {
  constexpr double alpha = 8.6;
  HostKernel k = asked;
  k.per_cell = 1023;
  Eigen::VectorXd table(7 * k.per_cell / 2 + 1);
  const auto last = static_cast<double>(table.size() - 1);
  for (Eigen::Index i = 0; i < table.size(); ++i) {
    const double part = static_cast<double>(i) / last, turn = std::numbers::pi * static_cast<double>(i) / k.per_cell;
    table[i] = std::cyl_bessel_i(0.0, alpha * std::sqrt(1 - part * part)) / std::cyl_bessel_i(0.0, alpha) *
               (i == 0 ? 1 : std::sin(turn) / turn);
  }
  return {kernels::nearest_entries(table, k.per_cell, 3), k.per_cell, dct_correction(table, k)};
}

void write_wsclean(const Emission& e, const std::string& path) {
  const HostKernel& k = e.table;
  const Eigen::VectorXd half = kernels::sampled_to_both_ends(k.kernel.polynomial, k.per_cell);
  const int taps = taps_of(k.kernel.width());
  const Eigen::Index middle = (static_cast<Eigen::Index>(taps) * k.per_cell - 1) / 2;
  Eigen::VectorXd table = Eigen::VectorXd::Zero(2 * middle + 1);
  for (Eigen::Index i = 0; i < std::min(half.size(), middle + 1); ++i) table[middle + i] = table[middle - i] = half[i];
  const std::string size = std::to_string(taps), sampling = std::to_string(k.per_cell);
  write_file(
      path,
      c_header(e,
               {"To use it, in WSClean's wstackinggridder.cpp:", "1. include this file; in makeKernels(), after the switch:",
                "     if (_kernelSize != misfit_kernel_size || _overSamplingFactor != misfit_oversampling)",
                "       throw std::runtime_error(\"run with the -kernel-size and -oversampling of the kernel\");",
                "     std::copy_n(misfit_kernel, _1dKernel.size(), _1dKernel.begin());",
                "2. in both correctImageForKernel(), where xVal and yVal are taken from a DCT that is half a pixel off:",
                "     xVal = misfit_divisor((double(x) - _width / 2) / _width) * _overSamplingFactor;",
                "     yVal = misfit_divisor((double(y) - _height / 2) / _height) * _overSamplingFactor;",
                "3. build, and run with  -kernel-size " + size + " -oversampling " + sampling + " -padding " +
                    significant(k.padding, 6) + " -no-small-inversion"},
               c_integer("kernel_size", taps) + c_integer("oversampling", k.per_cell) +
                   c_array("C at u = (i - " + std::to_string(middle) + ") / " + sampling, "kernel", table) +
                   c_divisor(e.divisor)));
}

}  // namespace

Host wsclean_host() {
  Host host;
  host.name = "wsclean";
  host.title = "WSClean's w-stacking gridder";
  host.habit = "the nearest entry of the table, no normalisation, the image divided by a DCT of the table";
  host.padding = 1.2;
  host.max_width = 20;
  host.table = {1023, 65535, true, false};
  host.depends_on_pixels = true;
  host.bits = 24;
  host.taps_of = taps_of;
  host.taps = [](const HostKernel& k) {
    return kernels::nearest_entries(kernels::sampled_to_both_ends(k.kernel.polynomial, k.per_cell), k.per_cell,
                                    taps_of(k.kernel.width()) / 2);
  };
  host.own_correction = [](const HostKernel& k) {
    return dct_correction(kernels::sampled_to_both_ends(k.kernel.polynomial, k.per_cell), k);
  };
  host.bytes = [](const HostKernel& k) { return 2.0 * taps_of(k.kernel.width()) * k.per_cell * sizeof(double); };
  host.stock = stock_of_wsclean;
  host.stock_name = "its Kaiser-Bessel function of 7 cells, 1023 entries a cell";
  host.write = write_wsclean;
  return host;
}

}  // namespace misfit::tools
