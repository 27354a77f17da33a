#include <cmath>
#include <limits>

#include "kernels/families/even_taps.h"
#include "kernels/families/families.h"
#include "kernels/families/tuned.h"

namespace misfit::kernels {
namespace {

/// I₀ of √x, by its power series, all of whose terms are positive (Abramowitz & Stegun 1964, eq. 9.6.12).
double bessel_i0_of_root(double x) {
  double term = 1;
  double sum = 1;
  for (int k = 1; term > sum * std::numeric_limits<double>::epsilon() / 4; ++k) {
    term *= x / 4 / (k * k);
    sum += term;
  }
  return sum;
}

TapFunction kaiser_bessel_taps(int width, double beta) {
  const double peak = bessel_i0_of_root(beta * beta);
  return taps_over_support(width, [beta, peak](double eta) { return bessel_i0_of_root(beta * beta * (1 - eta * eta)) / peak; });
}

}  // namespace

KernelFamily kaiser_bessel_family() {
  return tuned_family("kaiser-bessel", "I0(β √(1 − η²)), β tuned for the smallest mean error", kaiser_bessel_taps);
}

}  // namespace misfit::kernels
